#include "tests/scene/bad_edit.hpp"

#include <ostream>

#include "tests/scene/good_problem.hpp"

void pleuel::test::PrintTo(const BadEdit& bad, std::ostream* stream) {
  *stream << bad.pointer << " = " << bad.value;
}

namespace pleuel::test::bad_edit_test {
namespace {

TEST_P(BadProblemFile, IsRefusedWithPlaceValueAndRule) {
  const BadEdit& bad = GetParam();
  EXPECT_EQ(complaint(edited(bad.pointer, bad.value)), "bad.json: " + bad.message);
}

TEST_P(BadMechanismFile, IsRefusedWithPlaceValueAndRule) {
  const BadEdit& bad = GetParam();
  EXPECT_EQ(complaint(edited(good_mechanism(), bad.pointer, bad.value)),
            "bad.json: " + bad.message);
}

TEST(GoodProblemFile, IsNotRefused) {
  EXPECT_EQ(complaint(good_json()), "");
}

TEST(GoodMechanismFile, IsNotRefused) {
  EXPECT_EQ(complaint(good_mechanism()), "");
}

}  // namespace
}  // namespace pleuel::test::bad_edit_test
