#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/trust/joint_findings.hpp"
#include "tests/core/trust/crank_rocker.hpp"
#include "tests/core/trust/findings_of.hpp"
#include "tests/support/problem_runs.hpp"

namespace pleuel::test::blocked_drives_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// Elastic, so that it starts at all: nothing moves by more than its members bend.
std::vector<Finding> findings_with(const std::string& joint,
                                   const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides = {
      "/scene/bodies/crank/rigid=false",
      "/scene/bodies/coupler/rigid=false",
      "/scene/bodies/rocker/rigid=false",
      "/simulation/end_time=2e-5",
      "/simulation/step=1e-5",
      R"(/scene/joints/A/drive={"type": "ramp-to-speed", "speed": "300 rpm", "ramp": "1 s"})"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return findings_of(read_scene(crank_rocker("", joint), overrides), check_blocked_drives);
}

/// Nine rigid coordinates; with revolutes eight equations of joints, and one of the drive.
TEST(BlockedDrive, IsNamedWhereAJointHasAFreedomTooFew) {
  EXPECT_THAT(findings_with(closed), IsEmpty());
  const std::string welded =
      R"(, "D": {"type": "fixed", "bodies": ["ground", "rocker"], "at": [0.4, 0, 0]})";
  const auto findings = findings_with(welded);
  ASSERT_THAT(findings, SizeIs(1));
  EXPECT_THAT(findings[0].text, HasSubstr("the joints leave no motion to the drive of \"A\""));
}

TEST(BlockedDrive, IsOneOfTwoForOneFreedom) {
  const std::string driven_too =
      R"(, "D": {"type": "revolute", "bodies": ["ground", "rocker"], "at": [0.4, 0, 0],
                 "drive": {"type": "ramp-to-speed", "speed": "300 rpm", "ramp": "1 s"}})";
  const auto findings = findings_with(driven_too);
  ASSERT_THAT(findings, SizeIs(1));
  EXPECT_THAT(findings[0].text,
              HasSubstr("there is one drive more than the joints leave motions to (drives: \"A\", "
                        "\"D\")"));
}

TEST(BlockedDrive, IsOneWhoseLoopCannotTurnAboutItsAxis) {
  // In space, with one axis across the others.
  EXPECT_THAT(findings_with(closed, {"/scene/joints/B/axis=[1, 0, 0]"}), SizeIs(1));
}

/// A loop of revolutes in space has three equations more than it needs, and moves all the same.
TEST(BlockedDrive, IsNoneOfALoopThatMovesInSpace) {
  EXPECT_THAT(findings_with(closed, {R"(/effects={"spatial_motion": "on"})"}), IsEmpty());
}

/// The drive stands still: what is simulated is round-off, unless something else acts.
TEST(BlockedDrive, ThatStandsStillMovesNothing) {
  const auto findings_at = [](const std::string& speed, const std::vector<std::string>& more) {
    std::vector<std::string> overrides = {
        R"(/scene/joints/A/drive={"type": "constant-speed", "speed": ")" + speed + R"("})",
        "/simulation/end_time=2e-3", "/simulation/step=1e-4"};
    overrides.insert(overrides.end(), more.begin(), more.end());
    return findings_of(read_scene(crank_rocker("", closed), overrides), check_rest);
  };
  const auto findings = findings_at("0 rpm", {});
  ASSERT_THAT(findings, SizeIs(1));
  EXPECT_THAT(findings[0].text, HasSubstr("the drive of \"A\" stands still"));
  EXPECT_TRUE(findings[0].is_serious);
  EXPECT_THAT(findings_at("1 rpm", {}), IsEmpty());
  EXPECT_THAT(findings_at("0 rpm", {"/scene/gravity=[0, -9.81, 0]"}), IsEmpty());
}

class ShippedMechanism : public testing::TestWithParam<const char*> {};

TEST_P(ShippedMechanism, HasNoBlockedDrive) {
  const ProblemFile problem = sample_problem(GetParam(), {"/simulation/end_time=20 ms"});
  EXPECT_THAT(findings_of(problem, check_blocked_drives), IsEmpty());
}
INSTANTIATE_TEST_SUITE_P(Problems, ShippedMechanism,
                         testing::Values("slider_crank", "four_bar", "robot_arm",
                                         "spatial_slider_crank", "hard/dead_centres",
                                         "hard/bricard"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::erase(name, '/');
                           return name;
                         });

}  // namespace
}  // namespace pleuel::test::blocked_drives_test
