/// Velocities that the file gives.

#include "core/trust/initial_motion.hpp"

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/trust/findings_of.hpp"

namespace pleuel::test::initial_motion_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// A bar of 1 m on a hinge, whose frame is at its left end.
ProblemFile turning_bar(double hinge, const std::string& velocity) {
  return read_scene(fmt::format(
      R"({{"scene": {{"bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0],
          "material": "steel", "section": {{"type": "circle", "diameter": 0.03}}, "rigid": true,
          "elements": 1, "angular_velocity": [0, 0, 10], "velocity": {}}}}},
          "joints": {{"hinge": {{"type": "revolute", "bodies": ["ground", "bar"], "at": [{}, 0, 0]}}}}}},
          "simulation": {{"end_time": 0.01, "step": 0.001}}}})",
      velocity, hinge));
}

/// About its middle the left end goes down with ω/2; at rest it is not.
TEST(InitialMotion, IsADoubtWhereJointsChangeWhatTheFileGives) {
  EXPECT_THAT(findings_of(turning_bar(0.0, "[0, 0, 0]"), check_initial_motion), IsEmpty());
  EXPECT_THAT(findings_of(turning_bar(0.5, "[0, -5, 0]"), check_initial_motion), IsEmpty());
  const std::vector<Finding> findings =
      findings_of(turning_bar(0.5, "[0, 0, 0]"), check_initial_motion);
  ASSERT_THAT(findings, SizeIs(1));
  EXPECT_TRUE(findings[0].is_serious);
  EXPECT_THAT(findings[0].text, HasSubstr("the initial angular velocity of \"bar\""));
  EXPECT_THAT(findings[0].text, HasSubstr("instead of the 10 rad/s of the file"));
  EXPECT_THAT(findings_of(turning_bar(0.0, "[0, 3, 0]"), check_initial_motion), SizeIs(1));
}

/// A slide that is turned by five degrees against the velocity leaves cos 5° of it, 0.4 % less, but
/// in another direction; by half a degree all of it, as nearly as it matters.
TEST(InitialMotion, InAnotherDirectionIsADoubt) {
  const auto findings = [](double angle) {
    return findings_of(
        read_scene(fmt::format(
            R"({{"scene": {{"bodies": {{"block": {{"type": "rigid", "at": [0, 0, 0], "mass": 1,
                "inertia": [1, 1, 1, 0, 0, 0], "velocity": [{:.12g}, {:.12g}, 0]}}}},
              "joints": {{"slide": {{"type": "prismatic", "bodies": ["ground", "block"],
                                     "at": [0, 0, 0], "axis": [1, 0, 0]}}}}}},
              "simulation": {{"end_time": 0.02, "step": 0.01}}}})",
            2.0 * std::cos(angle), 2.0 * std::sin(angle))),
        check_initial_motion);
  };
  const double degree = 3.14159265358979 / 180;
  EXPECT_THAT(findings(0.5 * degree), IsEmpty());
  const std::vector<Finding> turned = findings(5.0 * degree);
  ASSERT_THAT(turned, SizeIs(1));
  EXPECT_THAT(turned[0].text, HasSubstr("in another direction instead of the 2 m/s"));
}

/// An elastic member begins without elastic rates, and takes the velocity of what it carries.
TEST(InitialMotion, OfAMassOnAnElasticMemberIsADoubt) {
  const std::vector<Finding> findings = findings_of(read_scene(
                                                        R"({"scene": {"bodies": {
            "arm": {"type": "beam", "from": [0, 0, 0], "to": [0.5, 0, 0], "material": "steel",
                    "section": {"type": "circle", "diameter": 0.02}, "elements": 2},
            "mass": {"type": "point-mass", "at": [0.5, 0, 0], "mass": 10, "velocity": [0, 0.1, 0]}},
          "joints": {"clamp": {"type": "fixed", "bodies": ["ground", "arm"], "at": [0, 0, 0]},
                     "tip": {"type": "spherical", "bodies": ["arm", "mass"], "at": [0.5, 0, 0]}}},
          "simulation": {"end_time": 0.01, "step": 0.001}})"),
                                                    check_initial_motion);
  ASSERT_THAT(findings, SizeIs(1));
  EXPECT_THAT(findings[0].text, HasSubstr("the initial velocity of \"mass\""));
}

}  // namespace
}  // namespace pleuel::test::initial_motion_test
