#include "core/scene/reading/suggestion.hpp"

#include <gtest/gtest.h>

namespace pleuel::test::suggestion_test {
namespace {

TEST(EditDistance, CountsInsertionsDeletionsReplacementsAndSwaps) {
  EXPECT_EQ(edit_distance("steel", "steel"), 0U);
  EXPECT_EQ(edit_distance("stel", "steel"), 1U);
  EXPECT_EQ(edit_distance("steeel", "steel"), 1U);
  EXPECT_EQ(edit_distance("steel", "steal"), 1U);
  EXPECT_EQ(edit_distance("setel", "steel"), 1U);
  EXPECT_EQ(edit_distance("", "steel"), 5U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);  // the textbook example
}

TEST(EditDistance, IsSymmetric) {
  EXPECT_EQ(edit_distance("thickness", "thicknes"), edit_distance("thicknes", "thickness"));
  EXPECT_EQ(edit_distance("sitting", "kitten"), 3U);
}

TEST(Suggestion, IsTheNearestOfTheNearWords) {
  EXPECT_EQ(closest("diamter", {"type", "diameter", "outer_diameter"}), "diameter");
  EXPECT_EQ(closest("rod_2", {"rod_10", "rod_21", "crank"}), "rod_21");
}

TEST(Suggestion, IsAbsentForWordsThatHaveNothingInCommon) {
  EXPECT_EQ(closest("colour", {"type", "diameter"}), "");
  EXPECT_EQ(closest("a", {"b"}), "");
  EXPECT_EQ(closest("x", {}), "");
}

TEST(Suggestion, IsAbsentForAWordOfAbsurdLength) {
  EXPECT_EQ(closest(std::string(100000, 'x'), {std::string(100001, 'x')}), "");
}

TEST(Hint, NamesTheKnownWordsIfNoneIsNear) {
  EXPECT_EQ(hint("colour", {"type", "width", "height"}),
            "; known are \"type\", \"width\" and \"height\"");
  EXPECT_EQ(hint("colour", {"type"}), "; known is \"type\"");
  EXPECT_EQ(hint("colour", {}), "; there are none");
}

}  // namespace
}  // namespace pleuel::test::suggestion_test
