#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/trust/lint.hpp"
#include "tests/core/trust/crank_rocker.hpp"
#include "tests/core/trust/findings_of.hpp"

namespace pleuel::test::far_limits_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// Three steel rods of 20 mm have some kilograms.
std::vector<Finding> findings_with_limit(const std::string& limit) {
  return findings_of(
      read_scene(crank_rocker(driven, closed),
                 {"/variables/d={\"start\": \"20 mm\", \"lower\": \"10 mm\", \"upper\": \"30 mm\"}",
                  R"(/scene/bodies/rocker/section/diameter={"variable": "d"})",
                  R"(/objective={"minimize": "m"})",
                  R"(/constraints/heavy={"response": "m", )" + limit + "}"}),
      check_far_limits);
}

TEST(FarLimit, IsOneInAnotherUnit) {
  const auto findings = findings_with_limit(R"("upper": "80 mg")");
  ASSERT_THAT(findings, SizeIs(1));
  EXPECT_THAT(findings[0].text, HasSubstr("the limit of \"heavy\" is 8e-05 kg, and the value 1."));
  EXPECT_THAT(findings_with_limit(R"("lower": 1e6)"), SizeIs(1));
}

TEST(FarLimit, IsNoneThatIsBrokenByLessOrZero) {
  EXPECT_THAT(findings_with_limit(R"("upper": "1 g")"), IsEmpty());
  EXPECT_THAT(findings_with_limit(R"("upper": 0)"), IsEmpty());
  EXPECT_THAT(findings_with_limit(R"("upper": 1e9)"), IsEmpty());
  EXPECT_THAT(findings_with_limit(R"("lower": 1e3)"), IsEmpty());
}

}  // namespace
}  // namespace pleuel::test::far_limits_test
