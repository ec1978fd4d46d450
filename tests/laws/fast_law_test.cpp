#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/base/eager_matrices.hpp"
#include "core/response/monitors.hpp"
#include "core/trust/checks.hpp"
#include "core/trust/fast_laws.hpp"
#include "tests/laws/law_problems.hpp"

namespace pleuel::test::fast_law_test {
namespace {

std::vector<Finding> findings_about(const ProblemFile& problem) {
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const Monitors monitors = monitor(analysis->model, analysis->trajectory);
  return check_fast_laws(TrustedRun{problem, x, *analysis, monitors});
}

std::string harmonic(double steps_a_period) {
  return R"({"type": "harmonic", "amplitude": 4, "frequency": )" +
         std::to_string(2 * 3.14159265358979 / (steps_a_period * 1e-3)) + "}";
}

/// A share of 1 − cos(π/n) of its amplitude is missed between two of n steps a period.
TEST(FastLoad, IsDoubtedFromTwentyTwoStepsAPeriodOn) {
  EXPECT_TRUE(findings_about(pushed_block(harmonic(23))).empty());
  for (const double steps : {21.0, 10.0, 2.0, 1.0, 0.5, 0.25, 0.1}) {
    const std::vector<Finding> findings = findings_about(pushed_block(harmonic(steps)));
    ASSERT_EQ(findings.size(), 2U) << steps;
    EXPECT_TRUE(findings[0].is_serious);
    EXPECT_THAT(findings[0].text, testing::HasSubstr("the load \"push\""));
  }
}

TEST(FastLoad, IsDoubtedWhereATableIsFinerThanTheSteps) {
  const auto pulse = [](double width) {
    const auto at = [&](int i) { return fmt::format("{:.12g}", 0.0503 + i * width); };
    return R"({"type": "table", "times": [)" + at(0) + "," + at(1) + "," + at(2) +
           R"(], "values": [0, 1, 0]})";
  };
  EXPECT_TRUE(findings_about(pushed_block(pulse(5e-3))).empty());
  for (const double width : {3e-4, 3e-6, 3e-9}) {
    const std::vector<Finding> findings = findings_about(pushed_block(pulse(width)));
    ASSERT_EQ(findings.size(), 2U) << width;
    EXPECT_EQ(findings[0].text.find("e+"), std::string::npos) << findings[0].text;
  }
}

/// A motor shall follow a pulse of 0.5 ms, or of 20 ms, in steps of 1 ms.
TEST(FastLoad, IsDoubtedOfTheTargetOfAMotor) {
  const auto followed = [](double rise) {
    return pushed_block(
        "1", {fmt::format(R"(/scene/loads/push={{"type": "joint", "joint": "slide", "motor":
            {{"type": "control", "target": {{"type": "trapezoid", "value": "10 mm", "rise": "{} ms",
            "hold": "0.1 ms", "begin": "50.3 ms"}}, "proportional": 100, "derivative": 10}}}})",
                          rise)});
  };
  const std::vector<Finding> findings = findings_about(followed(0.2));
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_TRUE(findings[0].is_serious);
  EXPECT_THAT(findings[0].text, testing::HasSubstr("the motor of the load \"push\""));
  EXPECT_THAT(findings[0].text, testing::HasSubstr("its target is"));
  EXPECT_TRUE(findings_about(followed(20)).empty());
}

TEST(FastLoad, IsKnownBeforeTheSimulation) {
  EXPECT_TRUE(check_fast_laws_before(pushed_block(harmonic(23))).empty());
  const ProblemFile fast = pushed_block(harmonic(10));
  EXPECT_EQ(texts_of(check_fast_laws_before(fast)), texts_of(findings_about(fast)));
}

TEST(FastLoad, IsNotDoubtedWhereItJumpsOnAnInstant) {
  EXPECT_TRUE(findings_about(pushed_block(R"({"type": "table", "times": [0, 0.0313],
                                            "values": [0, 6], "interpolation": "step"})"))
                  .empty());
}

/// A disc on a bearing.
ProblemFile driven_disc(const std::string& drive) {
  return read_problem_text(
             R"({"scene": {
    "bodies": {"disc": {"type": "rigid", "at": [0, 0, 0], "mass": 2, "inertia": [1, 1, 1, 0, 0, 0]}},
    "joints": {"bearing": {"type": "revolute", "bodies": ["ground", "disc"], "at": [0, 0, 0], "drive": )" +
                 drive + R"(}}},
  "simulation": {"end_time": 0.1, "step": 1e-3},
  "responses": {"torque": {"type": "drive-torque", "joint": "bearing", "over_time": "max-abs"}}})",
             "disc.json")
      .complete();
}

/// 32 steps a revolution of 1 ms each are 196 rad/s; 1 − cos(π/32) is 0.5 %.
TEST(FastDrive, IsDoubtedBelowThirtyTwoStepsARevolution) {
  EXPECT_TRUE(findings_about(driven_disc(R"({"type": "constant-speed", "speed": 190})")).empty());
  for (const char* speed : {"205", "3000", "6283.185"}) {
    const std::vector<Finding> findings = findings_about(
        driven_disc(std::string(R"({"type": "constant-speed", "speed": )") + speed + "}"));
    ASSERT_EQ(findings.size(), 1U) << speed;
    EXPECT_THAT(findings[0].text, testing::HasSubstr("the drive of the joint \"bearing\""));
  }
}

TEST(FastDrive, IsDoubtedWhereItsRampIsAFewSteps) {
  const auto ramp = [](const char* time) {
    return driven_disc(std::string(R"({"type": "ramp-to-speed", "speed": 10, "ramp": )") + time +
                       "}");
  };
  EXPECT_TRUE(findings_about(ramp("0.03")).empty());
  EXPECT_EQ(findings_about(ramp("0.008")).size(), 1U);
  EXPECT_EQ(findings_about(ramp("0.0005")).size(), 1U);
}

TEST(DriveOfStraightLines, IsDoubtedWhereItsSpeedJumps) {
  const auto lines = [](const char* values) {
    return driven_disc(std::string(R"({"type": "table", "times": [0, 0.05, 0.1],
                                       "interpolation": "linear", "values": )") +
                       values + "}");
  };
  EXPECT_TRUE(findings_about(lines("[0, 0.1, 0.2]")).empty());
  const std::vector<Finding> findings = findings_about(lines("[0, 0.1, 0.1]"));
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_TRUE(findings[0].is_serious);
  EXPECT_THAT(findings[0].text, testing::HasSubstr("its speed jumps at t = 0.05 s"));
}

}  // namespace
}  // namespace pleuel::test::fast_law_test
