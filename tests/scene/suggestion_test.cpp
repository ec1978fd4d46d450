#include "core/scene/reading/suggestion.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/scene/material_library.hpp"
#include "core/scene/reading/other_names.hpp"
#include "tests/support/source_folder.hpp"

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

TEST(Suggestion, IsWhatOthersCallSo) {
  EXPECT_EQ(meant_by("E", {"young", "poisson", "density"}), "young");
  EXPECT_EQ(meant_by("rho", {"young", "poisson", "density"}), "density");
  EXPECT_EQ(meant_by("hinge", {"fixed", "prismatic", "revolute"}), "revolute");
  EXPECT_EQ(meant_by("aluminum", {"steel", "aluminium-6082-T6"}), "aluminium-6082-T6");
  EXPECT_EQ(meant_by("STEEL", {"steel", "pom"}), "steel");
  EXPECT_EQ(meant_by("von_mises", {"mass", "stress"}), "stress");
  EXPECT_EQ(meant_by("hinge", {"mass", "stress"}), "");
  EXPECT_EQ(meant_by("diamter", {"type", "diameter"}), "diameter");
  EXPECT_EQ(closest("hinge", {"fixed", "prismatic", "revolute"}), "");
  EXPECT_EQ(meant_by("yields", {"height", "width"}), "");
}

/// Names that other_names.hpp leads to are words of the schema or of the materials.
TEST(Suggestion, LeadsToWordsThatThereAre) {
  std::ifstream stream(source_folder() + "/problems/problem.schema.json");
  const std::string schema{std::istreambuf_iterator<char>(stream), {}};
  ASSERT_FALSE(schema.empty());
  const std::vector<Material> library = material_library();
  for (const auto& row : other_names) {
    const std::string_view name = row.second;
    const bool is_material =
        std::any_of(library.begin(), library.end(),
                    [&](const Material& material) { return material.name.starts_with(name); });
    const bool is_word = schema.find(fmt::format("\"{}\"", name)) != std::string::npos;
    EXPECT_TRUE(is_material || is_word) << name;
  }
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
