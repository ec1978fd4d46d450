#include "core/base/error.hpp"
#include "core/response/analysis.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::loose_pin_test {
namespace {

constexpr double mass = 2.0, gravity = 9.81, stiffness = 1e6, clearance = 1e-3, rounding = 1e-6;

/// A pin in the middle of a hole, which is a spring between two points that coincide.
ProblemFile loose_pin(const std::string& spring, const std::string& variables = "{}") {
  return problem_from(fmt::format(R"({{"scene": {{"gravity": [0, -9.81, 0],
          "bodies": {{"pin": {{"type": "point-mass", "at": [0, 0, 0], "mass": 2}}}}, "joints": {{}},
          "loads": {{"hole": {{"type": "spring", "bodies": ["ground", "pin"],
                               "at": [[0, 0, 0], [0, 0, 0]], {}}}}}}},
        "simulation": {{"end_time": "36 ms", "step": "2.5 us"}},
        "variables": {},
        "responses": {{
          "lowest": {{"type": "position", "body": "pin", "direction": "y", "over_time": "min"}},
          "blow": {{"type": "spring-force", "load": "hole", "over_time": "max"}}}}}})",
                                  spring, variables));
}

/// It falls onto the rim, and with b = c + δ/2 for the rim and u for how far it is pressed into it
///     m g (b + u) = k u²/2 + k δ²/24
/// the last being what the work in the rounding differs from that of a spring that begins in its
/// middle. So du/dc = m g/(k u − m g).
TEST(LoosePin, FallsOntoTheRimAsEnergySays) {
  const ProblemFile problem =
      loose_pin(R"("free_length": 0, "resistance": {"type": "clearance",
      "upper": {"variable": "c"}, "stiffness": 1e6, "rounding": "1 um"})",
                R"({"c": {"start": "1 mm", "lower": "0.1 mm", "upper": "2 mm"}})");
  const double weight = mass * gravity, rim = clearance + rounding / 2.0;
  const double work = weight * rim - stiffness * rounding * rounding / 24.0;
  const double depth = (weight + std::sqrt(weight * weight + 2.0 * stiffness * work)) / stiffness;
  const double change = weight / (stiffness * depth - weight);

  const auto analysis = analyze(problem, start_design(problem));
  // The scheme is (ω h)² = 3e-6 off, ω² = k/m. Gradients are less exact: the pin takes three steps for the
  // rounding, in which its stiffness begins.
  EXPECT_NEAR(analysis->reductions[0].value, -(rim + depth), 1e-6 * rim);
  EXPECT_NEAR(analysis->reductions[1].value, stiffness * depth, 3e-6 * stiffness * depth);
  const Eigen::MatrixXd slopes =
      gradients(problem, start_design(problem), *analysis, GradientMethod::direct);
  EXPECT_NEAR(slopes(0, 0), -(1.0 + change), 1e-3 * change);
  EXPECT_NEAR(slopes(1, 0), stiffness * change, 1e-3 * stiffness * change);
}

/// A spring of no length pulls k D, wherever its ends are: from the middle it swings about the
/// deflection by its weight, down to twice that.
TEST(LoosePin, OfASpringWithoutLengthSwingsThroughTheMiddle) {
  const ProblemFile problem = loose_pin(R"("free_length": 0, "stiffness": "100 kN/m")");
  const auto analysis = analyze(problem, start_design(problem));
  const double lowest = -2.0 * mass * gravity / 1e5;
  EXPECT_NEAR(analysis->reductions[0].value, lowest, 1e-5 * std::abs(lowest));
}

/// Of others the direction is unknown: one that is read says so at once, one that depends on the design
/// where it is simulated.
TEST(LoosePin, IsRefusedWhereTheSpringHasALength) {
  EXPECT_THAT(thrown<InputError>([] { loose_pin(R"("free_length": "1 mm", "stiffness": 1e5)"); }),
              HasSubstr("two different points where \"free_length\" is not 0"));
  const ProblemFile formula = loose_pin(
      R"("free_length": 0, "resistance": {"type": "expression", "value": "= 1 N + 1 N/m*elongation"})");
  EXPECT_THAT(thrown<SimulationError>([&] { (void)analyze(formula, start_design(formula)); }),
              HasSubstr("its ends coincide at t = 0 s"));
}

}  // namespace
}  // namespace pleuel::test::loose_pin_test
