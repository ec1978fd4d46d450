#include "core/trust/check_list.hpp"
#include "core/trust/fast_laws.hpp"
#include "tests/core/trust/findings_of.hpp"
#include "tests/support/test.hpp"

/// Forces over the angle of a joint, and rotors, that turn too far in a step.
namespace pleuel::test::laws_over_coordinates_test {
namespace {

/// A rotor of 1250 rpm in 96 ms, two turns, with a resistance over its angle.
ProblemFile rotor(const std::string& resistance, double step, const std::string& plane = "auto") {
  return read_scene(fmt::format(
      R"j({{"scene": {{
        "bodies": {{"rotor": {{"type": "rigid", "at": [0, 0, 0], "mass": 1,
                              "inertia": [0.01, 0.01, 0.02, 0, 0, 0],
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
              "joints": {{"b": {{"type": "revolute", "bodies": ["ground", "wheel"],
                                "at": [0, 0, 0]}}}}}},
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
}  // namespace pleuel::test::laws_over_coordinates_test
