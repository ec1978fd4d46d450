/// DegreesOfFreedom that nothing moves, and bodies that nothing holds.

#include "core/trust/unactuated_freedoms.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scene/problem_reader.hpp"
#include "core/trust/joint_findings.hpp"
#include "core/trust/proportions.hpp"
#include "tests/core/trust/crank_rocker.hpp"
#include "tests/core/trust/findings_of.hpp"
#include "tests/support/problem_runs.hpp"

namespace pleuel::test::unactuated_freedoms_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

TEST(IdleFreedoms, AreNotInADrivenMechanism) {
  EXPECT_THAT(findings_of(read_scene(crank_rocker(driven, closed)), check_unactuated_freedoms),
              IsEmpty());
}

TEST(IdleFreedoms, OfAForgottenDriveAreNamedByBody) {
  const std::vector<Finding> findings =
      findings_of(read_scene(crank_rocker("", closed)), check_unactuated_freedoms);
  ASSERT_THAT(findings, SizeIs(1));
  EXPECT_TRUE(findings[0].is_serious);
  EXPECT_THAT(findings[0].text,
              HasSubstr("\"crank\", \"coupler\", \"rocker\" can move freely (one free motion)"));
  EXPECT_THAT(findings[0].text, HasSubstr("nothing moves there"));
  EXPECT_THAT(findings[0].responses, testing::ElementsAre("v"));
}

TEST(IdleFreedoms, OfAForgottenJointAreNamedByBody) {
  const std::vector<Finding> findings =
      findings_of(read_scene(crank_rocker(driven, "")), check_unactuated_freedoms);
  ASSERT_THAT(findings, SizeIs(1));
  EXPECT_TRUE(findings[0].is_serious);
  EXPECT_THAT(findings[0].text,
              HasSubstr("\"coupler\", \"rocker\" can move freely (2 free motions)"));
  EXPECT_THAT(findings[0].text, HasSubstr("only the inertia"));
}

/// With weight what a forgotten joint leaves hangs on the crank, which may be meant; with friction it is.
TEST(IdleFreedoms, ThatHangBesideADriveAreMentioned) {
  const std::string weight = "[0, -9.81, 0]";
  const std::vector<Finding> findings =
      findings_of(read_scene(crank_rocker(driven, "", weight)), check_unactuated_freedoms);
  ASSERT_THAT(findings, SizeIs(1));
  EXPECT_FALSE(findings[0].is_serious);
  EXPECT_THAT(findings[0].text,
              HasSubstr("beside the drives \"coupler\", \"rocker\" can move freely (2 "
                        "free motions), with nothing but weight that acts on them"));
  EXPECT_THAT(
      findings_of(read_scene(crank_rocker(driven, closed, weight)), check_unactuated_freedoms),
      IsEmpty());
  const std::string friction =
      R"(/scene/loads={"b": {"type": "joint", "joint": "B", "damping": 0.1},
                       "c": {"type": "joint", "joint": "C", "damping": 0.1}})";
  EXPECT_THAT(findings_of(read_scene(crank_rocker(driven, "", weight), {friction}),
                          check_unactuated_freedoms),
              IsEmpty());
}

/// Weight, a spring, a damper or a motor, a push, a start that moves: all of these are meant.
TEST(IdleFreedoms, AreNotWhereSomethingActs) {
  const auto load = [](const std::string& text) { return "/scene/loads={\"load\": " + text + "}"; };
  const std::string crank_joint = R"("type": "joint", "joint": "A")";
  for (
      const std::string& override_text :
      {std::string("/scene/gravity=[0, -9.81, 0]"),
       std::string("/scene/bodies/crank/angular_velocity=[0, 0, 3]"),
       load(
           R"({"type": "force", "body": "rocker", "at": [0.4, 0.2, 0], "direction": [1, 0, 0], "value": 1})"),
       load(R"({"type": "force", "body": "rocker", "at": [0.4, 0.2, 0], "direction": [1, 0, 0],
                 "value": {"type": "table", "times": [0, 0.01, 0.02], "values": [0, 1, 0]}})"),
       load(R"({"type": "spring", "bodies": ["ground", "rocker"],
                 "at": [[0.5, 0.2, 0], [0.4, 0.2, 0]], "stiffness": 100})")}) {
    EXPECT_THAT(findings_of(read_scene(crank_rocker("", closed), {override_text}),
                            check_unactuated_freedoms),
                IsEmpty())
        << override_text;
  }
}

/// Links that hang on a driven crank, so many that a basis of their motions would take longer than to
/// simulate them: each is free to turn.
TEST(IdleFreedoms, OfALongChainAreCounted) {
  constexpr int links = 120;
  std::string bodies = R"("crank": {"type": "rigid", "at": [0, 0, 0], "mass": 1,
                                    "inertia": [0.1, 0.1, 0.1, 0, 0, 0]})",
              joints = R"("A": {"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0],
                                "drive": {"type": "constant-speed", "speed": 1}})",
              last = "crank";
  for (int i = 0; i < links; ++i) {
    bodies += fmt::format(R"(, "b{}": {{"type": "rigid", "at": [{}, 0, 0], "mass": 1,
                                        "inertia": [0.1, 0.1, 0.1, 0, 0, 0]}})",
                          i, i + 1.5);
    joints += fmt::format(
        R"(, "j{0}": {{"type": "revolute", "bodies": ["{1}", "b{0}"], "at": [{2}, 0, 0]}})", i,
        last, i + 1);
    last = fmt::format("b{}", i);
  }
  const ProblemFile problem =
      read_problem_text(
          fmt::format(
              R"({{"scene": {{"gravity": [0, -9.81, 0], "bodies": {{{}}}, "joints": {{{}}}}},
                       "simulation": {{"end_time": 2e-3, "step": 1e-3}}, "responses": {{}}}})",
              bodies, joints),
          "chain.json")
          .complete();
  const std::vector<Finding> findings = findings_of(problem, check_unactuated_freedoms);
  ASSERT_THAT(findings, SizeIs(1));
  EXPECT_THAT(findings[0].text, HasSubstr("(120 free motions)"));
  EXPECT_THAT(findings[0].bodies, SizeIs(links));
}

TEST(IdleFreedoms, AreNotInTheProblemsOfTheHouse) {
  for (const char* name :
       {"spatial_slider_crank", "robot_arm", "four_bar", "hard/dead_centres", "hard/free_vibration",
        "hard/bricard", "hard/flyball_governor", "hard/squeezer", "hard/change_point"}) {
    ProblemFile problem = sample_problem(name);
    problem.simulation.end_time = 2.0 * problem.simulation.step;
    problem.responses.clear();
    for (const FindChecks find : {check_unactuated_freedoms, check_unconnected_bodies,
                                  check_proportions, check_misaligned_joints}) {
      EXPECT_THAT(findings_of(problem, find), IsEmpty()) << name;
    }
  }
}

/// The spin of a rod between ball joints does nothing.
TEST(IdleFreedoms, AreNotTheSpinOfARodBetweenBallJoints) {
  ProblemFile problem = sample_problem("spatial_slider_crank", {"/simulation/end_time=2 ms"});
  for (Joint& joint : problem.scene.joints) {
    if (joint.name == "slider_pin") joint.type = JointType::spherical;
  }
  EXPECT_THAT(findings_of(problem, check_unactuated_freedoms), IsEmpty());
}

TEST(UnconnectedBodies, AreNamed) {
  const auto stray_with = [](const std::string& more) {
    return R"(/scene/bodies/stray={"type": "point-mass", "at": [0.2, 0.3, 0], "mass": 1)" + more +
           "}";
  };
  const std::string stray = stray_with("");
  const std::string other =
      R"(/scene/bodies/other={"type": "point-mass", "at": [0.3, 0.3, 0], "mass": 1})";
  const std::string tie =
      R"(/scene/joints/tie={"type": "distance", "bodies": ["stray", "other"], "at": [0.2, 0.3, 0], "to": [0.3, 0.3, 0]})";
  const std::vector<Finding> still = findings_of(
      read_scene(crank_rocker(driven, closed), {stray, other, tie}), check_unconnected_bodies);
  ASSERT_THAT(still, SizeIs(1));
  EXPECT_THAT(still[0].text, HasSubstr("connects \"stray\", \"other\" with the ground"));
  EXPECT_FALSE(still[0].is_serious) << "no response looks at it";
  const std::vector<Finding> falling = findings_of(
      read_scene(crank_rocker(driven, closed, "[0, -9.81, 0]"),
                 {stray, other, tie, R"(/responses/y={"type": "position", "body": "stray",
                                 "direction": "y", "over_time": "final"})"}),
      check_unconnected_bodies);
  ASSERT_THAT(falling, SizeIs(1));
  EXPECT_TRUE(falling[0].is_serious);
  EXPECT_THAT(findings_of(read_scene(crank_rocker(driven, closed),
                                     {stray_with(R"(, "velocity": [1, 2, 0])"), other, tie}),
                          check_unconnected_bodies),
              IsEmpty());
}

}  // namespace
}  // namespace pleuel::test::unactuated_freedoms_test
