/// Joints whose axes do not fit together.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/trust/joint_findings.hpp"
#include "tests/core/trust/crank_rocker.hpp"
#include "tests/core/trust/findings_of.hpp"
#include "tests/support/parameter_name.hpp"

namespace pleuel::test::misaligned_joints_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// A door of 10 kg, 1 m wide, on two hinges 2 m apart, whose axes are tilted against each other.
std::string door(double tilt, const std::string& up = "z", double unit = 1.0) {
  const auto point = [&](double across, double height) {
    return up == "z" ? fmt::format("[{:.17g}, 0, {:.17g}]", across * unit, height * unit)
                     : fmt::format("[{:.17g}, {:.17g}, 0]", height * unit, across * unit);
  };
  const std::string straight = up == "z" ? "[0, 0, 1]" : "[1, 0, 0]";
  const std::string tilted =
      up == "z" ? fmt::format("[{:.17g}, 0, 1]", tilt) : fmt::format("[1, {:.17g}, 0]", tilt);
  const std::string gravity = up == "z" ? "[0, -9.81, 0]" : "[0, 0, -9.81]";
  return fmt::format(
      R"({{"scene": {{"gravity": {}, "bodies": {{"door": {{"type": "rigid", "at": {}, "mass": 10,
          "inertia": [{:.17g}, {:.17g}, {:.17g}, 0, 0, 0]}}}},
          "joints": {{"low": {{"type": "revolute", "bodies": ["ground", "door"], "at": {}, "axis": {}}},
                      "high": {{"type": "revolute", "bodies": ["ground", "door"], "at": {}, "axis": {}}}}}}},
          "simulation": {{"end_time": 0.1, "step": 0.002}}, "effects": {{"spatial_motion": "on"}},
          "responses": {{"force": {{"type": "reaction-force", "joint": "low", "direction": "magnitude",
                                    "over_time": "max"}}}}}})",
      gravity, point(0.5, 0.0), unit * unit, unit * unit, unit * unit, point(0.0, -1.0), straight,
      point(0.0, 1.0), tilted);
}

class TiltedHinges : public testing::TestWithParam<std::tuple<double, std::string, double>> {
 protected:
  std::string text_ =
      door(std::get<0>(GetParam()), std::get<1>(GetParam()), std::get<2>(GetParam()));
};
class NearlyAlignedHinges : public TiltedHinges {};
class SlightlyTiltedHinges : public TiltedHinges {};

/// The door falls like a pendulum, from rest at the horizontal: the force of both hinges together
/// is below 1.5 m g + m g (vertical), each carries at most all of it.
TEST_P(NearlyAlignedHinges, Swing) {
  const ProblemFile problem = read_scene(text_);
  const auto analysis = analyze(problem, start_design(problem));
  EXPECT_THAT(analysis->model.mechanism.system->left_out(), SizeIs(5));
  EXPECT_LE(analysis->reductions[0].value, 3.0 * 10 * 9.81);
  EXPECT_THAT(findings_of(problem, check_misaligned_joints), IsEmpty());
  Monitors monitors = monitor(analysis->model, analysis->trajectory);
  EXPECT_LE(monitors.position_drift, 1e-9);  // of what is kept
}

TEST_P(SlightlyTiltedHinges, AreNamed) {
  const std::vector<Finding> findings = findings_of(read_scene(text_), check_misaligned_joints);
  ASSERT_THAT(findings, SizeIs(1));
  EXPECT_TRUE(findings[0].is_serious);
  EXPECT_THAT(findings[0].text, HasSubstr("\"low\", \"high\""));
  EXPECT_THAT(findings[0].text, HasSubstr("\"door\""));
}

const auto directions = testing::Values("x", "z");
const auto units = testing::Values(1.0, 1e-3);
INSTANTIATE_TEST_SUITE_P(Tilts, NearlyAlignedHinges,
                         testing::Combine(testing::Values(0.0, 1e-12, 1e-9, 1e-8, 1e-7), directions,
                                          units),
                         named_as_printed());
INSTANTIATE_TEST_SUITE_P(Tilts, SlightlyTiltedHinges,
                         testing::Combine(testing::Values(1e-5, 1e-4, 1e-3, 1e-2), directions,
                                          units),
                         named_as_printed());

/// The same door on a carriage that drives off with it: what it does against the carriage counts,
/// not that it moves at all.
TEST(MisalignedJoints, LockABodyAlsoWhereItIsCarriedAway) {
  const auto findings_with = [](double tilt) {
    return findings_of(
        read_scene(door(tilt),
                   {R"(/scene/bodies/carriage={"type": "rigid", "at": [0, 0, 0], "mass": 5,
                  "inertia": [1, 1, 1, 0, 0, 0]})",
                    R"(/scene/joints/rail={"type": "prismatic", "bodies": ["ground", "carriage"],
                  "at": [0, 0, 0], "axis": [0, 1, 0],
                  "drive": {"type": "polynomial", "coefficients": [0, 0, 20]}})",
                    R"(/scene/joints/low/bodies=["carriage", "door"])",
                    R"(/scene/joints/high/bodies=["carriage", "door"])"}),
        check_misaligned_joints);
  };
  EXPECT_THAT(findings_with(0.0), IsEmpty());
  for (const double tilt : {1e-5, 5e-4, 5e-3, 2e-2}) {
    const std::vector<Finding> findings = findings_with(tilt);
    ASSERT_THAT(findings, SizeIs(1)) << tilt;
    EXPECT_THAT(findings[0].text, HasSubstr("\"low\", \"high\"")) << tilt;
  }
}

/// Two ball joints make a hinge however near they are; so do points of a body that are a hundredth
/// of the mechanism apart.
TEST(MisalignedJoints, AreNotTwoBallJointsThatMakeAHinge) {
  const ProblemFile problem = read_scene(
      R"({"scene": {"gravity": [0, -9.81, 0],
          "bodies": {"door": {"type": "rigid", "at": [0.5, 0, 0], "mass": 10, "inertia": [1, 1, 1, 0, 0, 0]}},
          "joints": {"low": {"type": "spherical", "bodies": ["ground", "door"], "at": [0, 0, -0.01]},
                     "high": {"type": "point-on-line", "bodies": ["ground", "door"], "at": [0, 0, 0.01],
                              "axis": [0, 0, 1]}}},
          "simulation": {"end_time": 0.05, "step": 0.001}, "effects": {"spatial_motion": "on"}})");
  EXPECT_THAT(findings_of(problem, check_misaligned_joints), IsEmpty());
}

/// The problem says 1e-7 rad: three constraints of a planar loop in space follow from the others.
TEST(MisalignedJoints, OfALoopInSpaceThatIsDrivenAreRedundant) {
  const auto loop = [](double tilt) {
    return fmt::format(
        R"({{"scene": {{"materials": {{"m": {{"young": 2e11, "poisson": 0.3, "density": 7850}}}},
          "bodies": {{"crank": {{"type": "beam", "from": [0, 0, 0], "to": [0.1, 0, 0], "material": "m", "rigid": true, "elements": 1,
                                 "section": {{"type": "circle", "diameter": 0.01}}}},
                      "coupler": {{"type": "beam", "from": [0.1, 0, 0], "to": [0.4, 0.2, 0], "material": "m", "rigid": true, "elements": 1,
                                   "section": {{"type": "circle", "diameter": 0.01}}}},
                      "rocker": {{"type": "beam", "from": [0.4, 0.2, 0], "to": [0.4, 0, 0], "material": "m", "rigid": true, "elements": 1,
                                  "section": {{"type": "circle", "diameter": 0.01}}}}}},
          "joints": {{"A": {{"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0],
                             "drive": {{"type": "constant-speed", "speed": 10}}}},
                      "B": {{"type": "revolute", "bodies": ["crank", "coupler"], "at": [0.1, 0, 0]}},
                      "C": {{"type": "revolute", "bodies": ["coupler", "rocker"], "at": [0.4, 0.2, 0], "axis": [{0}, 0, 1]}},
                      "D": {{"type": "revolute", "bodies": ["ground", "rocker"], "at": [0.4, 0, 0], "axis": [0, {0}, 1]}}}}}},
          "simulation": {{"end_time": 0.3, "step": 0.001}}, "effects": {{"spatial_motion": "on"}},
          "responses": {{"T": {{"type": "drive-torque", "joint": "A", "over_time": "max-abs"}}}}}})",
        tilt);
  };
  const auto torque = [&](double tilt) {
    const ProblemFile problem = read_scene(loop(tilt));
    return analyze(problem, start_design(problem))->reductions[0].value;
  };
  const double expected = torque(0.0);
  for (const double tilt : {1e-9, 1e-8, 1e-7, 5e-7}) {
    EXPECT_NEAR(torque(tilt), expected, 1e-4 * expected) << tilt;
  }
  for (const double tilt : {1e-5, 1e-3, 1e-2}) {
    try {
      torque(tilt);
      ADD_FAILURE() << "a loop that is locked was driven";
    } catch (const SimulationError& error) {
      EXPECT_THAT(error.what(), HasSubstr("would hold a motion")) << tilt;
    }
  }
}

}  // namespace
}  // namespace pleuel::test::misaligned_joints_test
