#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/trust/lint.hpp"

namespace pleuel::test::far_bounds_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::vector<Finding> findings_of(double start, double lower, double upper) {
  ProblemFile problem;
  problem.variables = {{"width", start, lower, upper, "mm", quantities::length}};
  return check_far_bounds(problem);
}

TEST(FarBound, IsOneThatStandsForNone) {
  const auto findings = findings_of(0.02, 0.004, 1e6);
  ASSERT_THAT(findings, SizeIs(1));
  EXPECT_THAT(findings[0].text,
              HasSubstr("the upper bound of variable \"width\" is 1e+09 mm, 5e+07 "
                        "times its start"));
  EXPECT_THAT(findings_of(0.02, -1e30, 0.04), SizeIs(1));
}

TEST(FarBound, IsNoneThatStartOrOtherBoundComesNear) {
  EXPECT_THAT(findings_of(0.02, 0.0, 1.0), IsEmpty());
  EXPECT_THAT(findings_of(1e-9, -1.0, 1.0), IsEmpty());
  EXPECT_THAT(findings_of(0.0, -1e9, 1e9), IsEmpty());
  EXPECT_THAT(findings_of(1e6, 0.0, 1e6), IsEmpty());
}

}  // namespace
}  // namespace pleuel::test::far_bounds_test
