#include "tests/scene/bad_edit.hpp"

#include <ostream>

#include <fmt/format.h>

#include "tests/scene/good_problem.hpp"

void pleuel::test::PrintTo(const BadEdit& bad, std::ostream* stream) {
  *stream << bad.pointer << " = " << bad.value;
}

namespace pleuel::test::bad_edit_test {
namespace {

void expect_refusal(const Json& document, const BadEdit& bad) {
  const std::string complaint = test::complaint(document), first = "bad.json: " + bad.message;
  if (bad.mistakes == 1) {
    EXPECT_EQ(complaint, first);
  } else {
    EXPECT_TRUE(complaint.starts_with(fmt::format("{} mistakes:\n{}\n", bad.mistakes, first)))
        << complaint;
  }
}

TEST_P(BadProblemFile, IsRefusedWithPlaceValueAndRule) {
  const BadEdit& bad = GetParam();
  expect_refusal(edited(bad.pointer, bad.value), bad);
}

TEST_P(BadMechanismFile, IsRefusedWithPlaceValueAndRule) {
  const BadEdit& bad = GetParam();
  expect_refusal(edited(good_mechanism(), bad.pointer, bad.value), bad);
}

TEST(GoodProblemFile, IsNotRefused) {
  EXPECT_EQ(complaint(good_json()), "");
}

TEST(GoodMechanismFile, IsNotRefused) {
  EXPECT_EQ(complaint(good_mechanism()), "");
}

}  // namespace
}  // namespace pleuel::test::bad_edit_test
