#include "core/base/error.hpp"
#include "core/trust/check_list.hpp"
#include "core/trust/fast_laws.hpp"
#include "tests/core/trust/trust_scenes.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/test.hpp"

/// Forces over the angle of a joint, and rotors, that turn too far in a step.

namespace pleuel::test::joint_findings_test {
namespace {

// Springs in joints that turn.

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
  const Finding finding = only(findings_of(spring_rotor(33, space), check_joint_turns));
  EXPECT_TRUE(finding.is_serious);
  EXPECT_THAT(finding.text, HasSubstr("the joint \"bearing\" turns by more than half a turn"));
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

// Joints whose axes do not fit together.

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
  const auto [problem, x, analysis] = AtStart(read_scene(text_));
  EXPECT_THAT(analysis->model.mechanism.system->left_out(), SizeIs(5));
  EXPECT_LE(analysis->reductions[0].value, 3.0 * 10 * 9.81);
  EXPECT_THAT(findings_of(problem, check_misaligned_joints), IsEmpty());
  Monitors monitors = monitor(analysis->model, analysis->trajectory);
  EXPECT_LE(monitors.position_drift, 1e-9);  // of what is kept
}

TEST_P(SlightlyTiltedHinges, AreNamed) {
  const Finding finding = only(findings_of(read_scene(text_), check_misaligned_joints));
  EXPECT_TRUE(finding.is_serious);
  EXPECT_THAT(finding.text, HasSubstr("\"low\", \"high\""));
  EXPECT_THAT(finding.text, HasSubstr("\"door\""));
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
    EXPECT_THAT(thrown<SimulationError>([&] { torque(tilt); }), HasSubstr("would hold a motion"))
        << tilt;
  }
}

// What slides along beams.

/// A mass that is moved along a horizontal arm of 1 m, or beyond its end.
std::string scene_of_trolley(double from, double way, const std::string& arm) {
  return fmt::format(
      R"({{"gravity": [0, -9.81, 0], "bodies": {{
            "arm": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
                     "section": {{"type": "circle", "diameter": 0.03}}, "elements": 5{}}},
            "trolley": {{"type": "point-mass", "at": [{}, 0, 0], "mass": 1}}}},
          "joints": {{"clamp": {{"type": "fixed", "bodies": ["ground", "arm"], "at": [0, 0, 0]}},
                      "rail": {{"type": "point-on-line", "bodies": ["arm", "trolley"], "at": [{}, 0, 0],
                                "axis": [1, 0, 0], "drive": {{"type": "table", "times": [0, 0.2],
                                                              "values": [0, {}]}}}}}}}})",
      arm, from, from, way);
}

ProblemFile trolley(double from, double way, const std::string& arm) {
  return read_scene(
      fmt::format(R"({{"scene": {}, "simulation": {{"end_time": 0.2, "step": 0.01}}}})",
                  scene_of_trolley(from, way, arm)));
}

/// A carriage whose line goes past the tip of the arm: its force stays at the tip.
TEST(SlidingContact, IsNoneWhereTheLineBelongsToTheOtherBody) {
  const ProblemFile problem = read_scene(
      R"({"scene": {"gravity": [0, -9.81, 0], "bodies": {
            "arm": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
                    "section": {"type": "circle", "diameter": 0.03}, "elements": 5},
            "carriage": {"type": "rigid", "at": [1, 0, 0], "mass": 1, "inertia": [0.1, 0.1, 0.1, 0, 0, 0]}},
          "joints": {"clamp": {"type": "fixed", "bodies": ["ground", "arm"], "at": [0, 0, 0]},
                     "rail": {"type": "prismatic", "bodies": ["ground", "carriage"],
                              "at": [1, 0, 0], "axis": [1, 0, 0],
                              "drive": {"type": "table", "times": [0, 0.2], "values": [0, -0.6]}},
                     "slot": {"type": "point-on-line", "bodies": ["carriage", "arm"],
                              "at": [1, 0, 0], "axis": [1, 0, 0]}}},
          "simulation": {"end_time": 0.2, "step": 0.01}})");
  EXPECT_THAT(findings_of(problem, check_sliding_contacts), IsEmpty());
}

/// What moves has no bar then; the mass has.
TEST(SlidingContact, LeavesNumbersWithoutABar) {
  for (const bool is_elastic : {true, false}) {
    const ProblemFile problem =
        read_scene(fmt::format(R"({{"scene": {}, "simulation": {{"end_time": 0.2, "step": 0.01}},
                        "responses": {{"mass": {{"type": "mass"}},
                                       "force": {{"type": "drive-force", "joint": "rail", "over_time": "max"}}}}}})",
                               scene_of_trolley(0.2, 0.6, is_elastic ? "" : R"(, "rigid": true)")));
    const Trust trust = judge_run(StartRun(problem).run());
    EXPECT_TRUE(trust.errors[0]->is_modelled);
    EXPECT_EQ(trust.errors[1]->is_modelled, !is_elastic);
    EXPECT_FALSE(is_elastic && trust.errors[1]->is_resolved());
  }
}

TEST(SlidingContact, IsADoubtWhereItTravelsOverAnElasticBeam) {
  const Finding finding = only(findings_of(trolley(0.2, 0.6, ""), check_sliding_contacts));
  EXPECT_TRUE(finding.is_serious);
  EXPECT_THAT(finding.text, HasSubstr("\"trolley\" slides 0.6 m along the elastic beam \"arm\""));
  EXPECT_THAT(findings_of(trolley(0.2, 0.6, R"(, "frames": 2)"), check_sliding_contacts),
              SizeIs(1));
  EXPECT_THAT(findings_of(trolley(0.2, 0.01, ""), check_sliding_contacts), IsEmpty());
  EXPECT_THAT(findings_of(trolley(1.0, 0.6, ""), check_sliding_contacts), IsEmpty());
  EXPECT_THAT(findings_of(trolley(0.2, 0.6, R"(, "rigid": true)"), check_sliding_contacts),
              IsEmpty());
}

/// A rotor of 1250 rpm in 96 ms, two turns, with a resistance over its angle.
ProblemFile rotor(const std::string& resistance, double step, const std::string& plane = "auto") {
  return read_scene(fmt::format(
      R"j({{"scene": {{
        "bodies": {{"rotor": {{"type": "rigid", "at": [0, 0, 0], "mass": 1, "inertia": [0.01, 0.01, 0.02, 0, 0, 0],
                              "angular_velocity": [0, 0, "1250 rpm"]}}}},
        "joints": {{"b": {{"type": "revolute", "bodies": ["ground", "rotor"], "at": [0, 0, 0],
                          "drive": {{"type": "constant-speed", "speed": "1250 rpm"}}}}}},
        "loads": {{"cogging": {{"type": "joint", "joint": "b", "resistance": {}}}}}}},
      "effects": {{"spatial_motion": "{}"}},
      "simulation": {{"end_time": "96 ms", "step": {}}},
      "responses": {{"mean": {{"type": "drive-torque", "joint": "b", "over_time": "mean"}}}}}})j",
      resistance, plane, step));
}

/// 48 teeth a turn are 1000 a second: one a step of 1 ms, whose torque each step and each half of one
/// sees alike.
TEST(LawsOverJoints, AreDoubtedWhereAStepPassesATooth) {
  const std::string teeth = R"j({"type": "expression", "value": "= 1 N m*sin(48*angle + 1 rad)"})j";
  for (const char* plane : {"auto", "on"}) {
    const std::vector<Finding> findings =
        findings_of(rotor(teeth, 1e-3, plane), check_laws_over_coordinates);
    ASSERT_THAT(findings, SizeIs(1)) << plane;
    EXPECT_TRUE(findings[0].is_serious);
    EXPECT_THAT(findings[0].text, HasSubstr("the load \"cogging\" changes faster than the steps"));
    EXPECT_THAT(findings_of(rotor(teeth, 1e-4, plane), check_laws_over_coordinates), IsEmpty())
        << plane;
  }
}

/// The same teeth as a ripple of a fifth, with a whole number of them in each step: 48 teeth a turn of
/// 48 ms; and one that is resolved, or that is next to nothing.
TEST(LawsOverJoints, AreDoubtedWhereARippleIsInStepWithTheSteps) {
  const auto findings_at = [](double ripple, double step) {
    const std::string torque = fmt::format(
        R"j({{"type": "expression", "value": "= 1 N m + {} N m*sin(48*angle)"}})j", ripple);
    return findings_of(rotor(torque, step), check_laws_over_coordinates);
  };
  EXPECT_THAT(findings_at(0.2, 1e-3), SizeIs(1));
  EXPECT_THAT(findings_at(0.2, 2e-3), SizeIs(1));
  EXPECT_THAT(findings_at(0.02, 1e-3), SizeIs(1));
  EXPECT_THAT(findings_at(0.2, 1e-3 / 6), IsEmpty());
  EXPECT_THAT(findings_at(0.005, 1e-3), IsEmpty());
}

/// A peak of 0.2 rad in a table, at 6 rad a turn: steps of 1 ms are 0.13 rad, those of 4 ms 0.52.
TEST(LawsOverJoints, AreDoubtedWhereAStepPassesThePeakOfATable) {
  const std::string table =
      R"({"type": "table", "angles": [0, 2.9, 3.0, 3.1, 6.283185307179586],
          "values": [0, 0, 5, 0, 0], "period": 6.283185307179586, "interpolation": "linear"})";
  EXPECT_THAT(findings_of(rotor(table, 4e-3), check_laws_over_coordinates), SizeIs(1));
  EXPECT_THAT(findings_of(rotor(table, 2e-4), check_laws_over_coordinates), IsEmpty());
}

/// Friction that changes its sign within a step is none of these.
TEST(LawsOverJoints, AreNotDoubtedForTheirRates) {
  EXPECT_THAT(
      findings_of(
          rotor(R"j({"type": "expression", "value": "= 1 N m*tanh(speed/(1 rad/s))"})j", 1e-3),
          check_laws_over_coordinates),
      IsEmpty());
}

/// A wheel that nothing drives: at a turn a step it seems to stand still.
TEST(FastTurning, IsDoubtedBeyondAQuarterOfATurn) {
  const auto findings_at = [](double step) {
    return findings_of(read_scene(fmt::format(
                           R"j({{"scene": {{
              "bodies": {{"wheel": {{"type": "rigid", "at": [0, 0, 0], "mass": 1,
                                    "inertia": [0.01, 0.01, 0.02, 0, 0, 0],
                                    "angular_velocity": [0, 0, "100 rev/s"]}}}},
              "joints": {{"b": {{"type": "revolute", "bodies": ["ground", "wheel"], "at": [0, 0, 0]}}}}}},
            "simulation": {{"end_time": 0.1, "step": {}}}}})j",
                           step)),
                       check_fast_turning);
  };
  EXPECT_THAT(findings_at(2.4e-3), IsEmpty());  // 86 deg
  const Finding finding = only(findings_at(1e-2));
  EXPECT_TRUE(finding.is_serious);
  EXPECT_THAT(finding.text, HasSubstr("\"wheel\" turns by 360 deg within the step of 0.01 s"));
}

/// A block that is moved from 100 mm to 400 mm in a second, on a spring with a resistance.
ProblemFile sprung_block(const std::string& resistance, double step) {
  return read_scene(fmt::format(
      R"j({{"scene": {{"bodies": {{"m": {{"type": "point-mass", "at": ["100 mm", 0, 0], "mass": 2}}}},
        "joints": {{"g": {{"type": "point-on-line", "bodies": ["ground", "m"], "at": ["100 mm", 0, 0],
          "axis": [1, 0, 0], "drive": {{"type": "step", "to": "300 mm", "rise": "1 s"}}}}}},
        "loads": {{"s": {{"type": "spring", "bodies": ["ground", "m"],
          "at": [[0, 0, 0], ["100 mm", 0, 0]], "resistance": {}}}}}}},
      "simulation": {{"end_time": 1.2, "step": {}}},
      "responses": {{"F": {{"type": "spring-force", "load": "s", "over_time": "max"}}}}}})j",
      resistance, step));
}

/// A tooth of 1 mm on a way of 300 mm at up to 0.6 m/s, over the elongation or as a formula of it;
/// a hill of 100 mm is seen.
TEST(LawsOverSprings, AreDoubtedWhereAStepPassesATooth) {
  const auto table = [](double width) {
    return fmt::format(
        R"j({{"type": "table", "elongations": ["0 mm", "{} mm", "150 mm", "{} mm", "300 mm"],
        "values": [0, 0, 100, 0, 0]}})j",
        150 - width, 150 + width);
  };
  EXPECT_THAT(findings_of(sprung_block(table(0.5), 2.5e-3), check_laws_over_coordinates),
              SizeIs(1));
  EXPECT_THAT(findings_of(sprung_block(table(0.5), 5e-5), check_laws_over_coordinates), IsEmpty());
  EXPECT_THAT(findings_of(sprung_block(table(100), 2.5e-3), check_laws_over_coordinates),
              IsEmpty());
}

/// A peak at a speed that the block passes within a step, and friction, whose sign changes with it.
TEST(LawsOverSprings, AreDoubtedWhereASpeedIsPassedOver) {
  const std::string peak =
      R"j({"type": "table", "speeds": ["-1 m/s", "0.199 m/s", "0.2 m/s", "0.201 m/s", "1 m/s"],
      "values": [0, 0, 100, 0, 0]})j";
  EXPECT_THAT(findings_of(sprung_block(peak, 1e-2), check_laws_over_coordinates), SizeIs(1));
  EXPECT_THAT(findings_of(sprung_block(peak, 1e-5), check_laws_over_coordinates), IsEmpty());
  const std::string friction = R"j({"type": "friction", "value": 100, "speed": "1 mm/s"})j";
  EXPECT_THAT(findings_of(sprung_block(friction, 1e-2), check_laws_over_coordinates), IsEmpty());
}

}  // namespace
}  // namespace pleuel::test::joint_findings_test
