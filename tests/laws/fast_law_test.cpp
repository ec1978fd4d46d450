#include "core/base/eager_matrices.hpp"
#include "core/integration/damped_start.hpp"
#include "core/response/monitors.hpp"
#include "core/trust/checks.hpp"
#include "core/trust/fast_laws.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/laws/law_problems.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::fast_law_test {
namespace {

std::vector<Finding> findings_about(const ProblemFile& problem) {
  const auto [x, analysis] = started(problem);
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
    EXPECT_THAT(findings[0].text, HasSubstr("the load \"push\""));
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
  EXPECT_THAT(findings[0].text, HasSubstr("the motor of the load \"push\""));
  EXPECT_THAT(findings[0].text, HasSubstr("its target is"));
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
  return problem_from(R"({"scene": {
    "bodies": {"disc": {"type": "rigid", "at": [0, 0, 0], "mass": 2, "inertia": [1, 1, 1, 0, 0, 0]}},
    "joints": {"bearing": {"type": "revolute", "bodies": ["ground", "disc"], "at": [0, 0, 0], "drive": )" +
                      drive + R"(}}},
  "simulation": {"end_time": 0.1, "step": 1e-3},
  "responses": {"torque": {"type": "drive-torque", "joint": "bearing", "over_time": "max-abs"}}})");
}

/// 32 steps a revolution of 1 ms each are 196 rad/s; 1 − cos(π/32) is 0.5 %.
TEST(FastDrive, IsDoubtedBelowThirtyTwoStepsARevolution) {
  EXPECT_TRUE(findings_about(driven_disc(R"({"type": "constant-speed", "speed": 190})")).empty());
  for (const char* speed : {"205", "3000", "6283.185"}) {
    const std::vector<Finding> findings = findings_about(
        driven_disc(std::string(R"({"type": "constant-speed", "speed": )") + speed + "}"));
    ASSERT_EQ(findings.size(), 1U) << speed;
    EXPECT_THAT(findings[0].text, HasSubstr("the drive of the joint \"bearing\""));
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
  EXPECT_THAT(findings[0].text, HasSubstr("its speed jumps at t = 0.05 s"));
}

/// A rod of steel, hinged at one end, that is let go while it lies undeformed: gravity acts on it
/// all at once. Its height is the variable.
ProblemFile released_rod(const std::vector<std::string>& overrides = {}) {
  return problem_from(R"({
  "scene": {"gravity": [0, -9.81, 0],
    "bodies": {"rod": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
      "section": {"type": "rectangle", "width": 0.02, "height": {"variable": "height"}}, "elements": 8, "frame": "chord", "damping": {"stiffness": 1e-3}}},
    "joints": {"hinge": {"type": "revolute", "bodies": ["ground", "rod"], "at": [0, 0, 0]}}
  },
  "simulation": {"end_time": 0.1, "step": 2e-3},
  "variables": {"height": {"start": 0.02, "lower": 0.01, "upper": 0.1}},
  "responses": {
    "stress": {"type": "stress", "body": "rod", "over_time": "max"},
    "reaction": {"type": "reaction-force", "joint": "hinge", "direction": "magnitude", "over_time": "max"},
    "speed": {"type": "velocity", "body": "rod", "at": 1, "direction": "y", "over_time": "rms"}},
  "objective": {"minimize": "stress"}
})",
                      overrides);
}

/// The stress is that of steps four times as short, whatever the mesh and the scheme: 27 steps for
/// a period of the first vibration take up to 1 % for themselves. What a step makes of
/// accelerations that last for far less gave up to sixty times as much.
TEST(DampedStart, DoesNotRingWhateverTheMeshAndTheDampingOfTheScheme) {
  const double fine = value_at_start(released_rod({"/simulation/step=0.125 ms"}), "stress");
  for (const int elements : {4, 16, 64}) {
    for (const char* radius : {"0", "0.5", "0.8", "1"}) {
      for (const char* formulation : {"index-3", "index-1"}) {
        if (elements == 16 && std::string(formulation) == "index-1") continue;
        const ProblemFile problem = released_rod(
            {"/simulation/step=0.5 ms", fmt::format("/scene/bodies/rod/elements={}", elements),
             fmt::format("/simulation/spectral_radius={}", radius),
             fmt::format("/simulation/formulation={}", formulation)});
        EXPECT_NEAR(value_at_start(problem, "stress") / fine, 1.0, 0.02)
            << elements << " elements, radius " << radius << ", " << formulation;
      }
    }
  }
}

/// Without damping that is stiff in a step, the start is that of the equations.
TEST(DampedStart, TakesTheAccelerationsOfTheEquationsWhereTheStepResolvesTheDamping) {
  const auto [problem, x, analysis] = AtStart(
      released_rod({"/scene/bodies/rod/elements=1", "/scene/bodies/rod/damping/stiffness=1e-4",
                    "/effects/axial_elasticity=off"}));
  State start = state_of(analysis->trajectory, 0);
  const DampedStart gentle(analysis->model.mechanism, start, generalized_alpha(8e-6, 0.5), 0.0);
  EXPECT_EQ(gentle.a(), start.a);
  const AtStart stiff(released_rod({"/scene/bodies/rod/elements=32"}));
  start = state_of(stiff.analysis->trajectory, 0);
  const DampedStart damped(stiff.analysis->model.mechanism, start, generalized_alpha(2e-3, 0.5),
                           0.0);
  EXPECT_LT(damped.a().lpNorm<Eigen::Infinity>(), 0.1 * start.a.lpNorm<Eigen::Infinity>());
}

/// Reactions from the first step on, where the start rings but the steps are short enough to see
/// it.
class ReactionsOfASuddenStart : public testing::TestWithParam<const char*> {};

TEST_P(ReactionsOfASuddenStart, AreOfSecondOrderFromTheFirstStepOn) {
  const auto run = [](int steps) {
    return [steps](const std::string& formulation) {
      const ProblemFile problem = released_rod(
          {"/scene/bodies/rod/elements=1", "/scene/bodies/rod/damping/stiffness=1e-4",
           "/effects/axial_elasticity=off", "/simulation/end_time=4e-3",
           "/simulation/newton_tolerance=1e-13", "/simulation/formulation=" + formulation,
           fmt::format("/simulation/step={:.17g}", 4e-3 / steps)});
      return Eigen::MatrixXd(
          analyze(problem, start_design(problem))->trajectory.columns().lambda());
    };
  };
  const int reference_steps = 3200;
  const Eigen::MatrixXd reference = run(reference_steps)(GetParam());
  std::vector<double> sizes, errors, first;
  for (const int steps : {200, 400, 800}) {
    const Eigen::MatrixXd lambda = run(steps)(GetParam());
    const int ratio = reference_steps / steps;
    double worst = 0.0;
    for (int i = 1; i <= steps; ++i) {
      const double error = (lambda.col(i) - reference.col(i * ratio)).norm();
      if (i == 1) first.push_back(error);
      worst = std::max(worst, error);
    }
    sizes.push_back(1.0 / steps);
    errors.push_back(worst);
  }
  EXPECT_GE(observed_order(sizes, errors), 1.8);
  EXPECT_GE(observed_order(sizes, first), 1.8);
}

INSTANTIATE_TEST_SUITE_P(Formulations, ReactionsOfASuddenStart,
                         testing::Values("index-3", "stabilized-index-2", "index-1"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::erase(name, '-');
                           return name;
                         });

class GradientOfADampedStart : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(GradientOfADampedStart, IsThatOfItsSimulation) {
  std::vector<std::string> overrides = {"/simulation/newton_tolerance=1e-13",
                                        "/simulation/end_time=20 ms"};
  overrides.insert(overrides.end(), GetParam().begin(), GetParam().end());
  const ProblemFile problem = released_rod(overrides);
  const auto [direct, adjoint, expected] = law_gradients(problem);
  for (Eigen::Index i = 0; i < expected.rows(); ++i) {
    EXPECT_NEAR(adjoint(i, 0), direct(i, 0), 1e-10 * std::abs(direct(i, 0)));
    EXPECT_NEAR(direct(i, 0), expected(i, 0), 1e-6 * std::abs(expected(i, 0))) << i;
  }
}

using Overrides = std::vector<std::string>;
INSTANTIATE_TEST_SUITE_P(Schemes, GradientOfADampedStart,
                         testing::Values(Overrides{}, Overrides{"/simulation/spectral_radius=0"},
                                         Overrides{"/simulation/formulation=stabilized-index-2"},
                                         Overrides{"/simulation/formulation=index-1"},
                                         Overrides{"/simulation/scheme=newmark"},
                                         Overrides{"/simulation/scheme=implicit-euler"},
                                         Overrides{"/effects/spatial_motion=on"}),
                         named_as_printed());

}  // namespace
}  // namespace pleuel::test::fast_law_test
