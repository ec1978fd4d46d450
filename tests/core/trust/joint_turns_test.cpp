/// Springs in joints that turn.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/trust/joint_findings.hpp"
#include "tests/core/trust/findings_of.hpp"

namespace pleuel::test::joint_turns_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// ½ J ω² = ½ k φ² at φ = ω √(J/k): with J = 0.1 kg m², k = 10 N m/rad a tenth of ω [s].
ProblemFile spring_rotor(double speed, const std::string& effects) {
  return read_scene(fmt::format(
      R"({{"scene": {{"bodies": {{"rotor": {{"type": "rigid", "at": [0, 0, 0], "mass": 1,
          "inertia": [0.1, 0.1, 0.1, 0, 0, 0], "angular_velocity": [0, 0, {}]}}}},
          "joints": {{"bearing": {{"type": "revolute", "bodies": ["ground", "rotor"], "at": [0, 0, 0]}}}},
          "loads": {{"coil": {{"type": "joint", "joint": "bearing", "stiffness": 10}}}}}},
          "effects": {}, "simulation": {{"end_time": 0.4, "step": 0.002}}}})",
      speed, effects));
}

TEST(JointTurns, AreADoubtBeyondHalfATurnInSpace) {
  const std::string space = R"({"spatial_motion": "on"})";
  EXPECT_THAT(findings_of(spring_rotor(30, space), check_joint_turns), IsEmpty());
  const std::vector<Finding> findings = findings_of(spring_rotor(33, space), check_joint_turns);
  ASSERT_THAT(findings, SizeIs(1));
  EXPECT_TRUE(findings[0].is_serious);
  EXPECT_THAT(findings[0].text, HasSubstr("the joint \"bearing\" turns by more than half a turn"));
  EXPECT_THAT(findings_of(spring_rotor(60, "{}"), check_joint_turns), IsEmpty()) << "counted";
}

/// A damper does not ask how often it has turned.
TEST(JointTurns, AreNoneOfADamper) {
  ProblemFile problem = spring_rotor(60, R"({"spatial_motion": "on"})");
  EXPECT_THAT(findings_of(problem, check_joint_turns), SizeIs(1));
  auto& coil = std::get<JointForce>(problem.scene.loads[0].element);
  coil.stiffness = 0.0;
  coil.damping = 1e-3;
  EXPECT_THAT(findings_of(problem, check_joint_turns), IsEmpty());
}

/// What repeats with each turn does not ask either; what has another value after a turn jumps.
TEST(JointTurns, AreADoubtOfLawsThatDoNotRepeat) {
  for (const auto& [law, is_counted] : {std::pair("= 0.1 N m/rad*angle", true),
                                        {"= 0.1 N m*cos(2*angle) + 0.1 N m*t/(1 s)", false}}) {
    const ProblemFile problem = read_scene(fmt::format(
        R"({{"scene": {{"bodies": {{"rotor": {{"type": "rigid", "at": [0, 0, 0], "mass": 1,
            "inertia": [0.1, 0.1, 0.1, 0, 0, 0], "angular_velocity": [0, 0, 60]}}}},
            "joints": {{"bearing": {{"type": "revolute", "bodies": ["ground", "rotor"], "at": [0, 0, 0]}}}},
            "loads": {{"cam": {{"type": "torque", "body": "rotor", "at": [0, 0, 0], "direction": [0, 0, 1],
              "value": {{"type": "expression", "joint": "bearing", "value": "{}"}}}}}}}},
            "effects": {{"spatial_motion": "on"}}, "simulation": {{"end_time": 0.1, "step": 0.002}}}})",
        law));
    EXPECT_THAT(findings_of(problem, check_joint_turns), SizeIs(is_counted ? 1 : 0)) << law;
  }
}

}  // namespace
}  // namespace pleuel::test::joint_turns_test
