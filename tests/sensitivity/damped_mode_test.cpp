#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"
#include "sensitivity/gradients.hpp"

/// Damping ratios and growth rates of small vibrations.
namespace pleuel::test::damped_mode_test {
namespace {

struct Found {
  Eigen::VectorXd values;
  Eigen::MatrixXd gradients;  ///< a row each response
};

Found found_of(const std::string& text) {
  const ProblemFile problem = read_problem_text(text, "test.json", {}).complete();
  const auto analysis = analyze(problem, start_design(problem));
  return {values_of(*analysis), direct_gradients(*analysis)};
}

/// A mass on a spring and a damper, m = 2 kg, k = 800 N/m: ω = 20 rad/s.
Found oscillator(double damping) {
  return found_of(fmt::format(R"({{"scene": {{"gravity": [0, 0, 0],
      "bodies": {{"m": {{"type": "point-mass", "at": [1, 0, 0], "mass": {{"variable": "m"}}}}}},
      "joints": {{"rail": {{"type": "point-on-line", "bodies": ["ground", "m"], "at": [1, 0, 0],
                           "axis": [1, 0, 0]}}}},
      "loads": {{"s": {{"type": "spring", "bodies": ["ground", "m"], "at": [[0, 0, 0], [1, 0, 0]],
                       "stiffness": {{"variable": "k"}}, "damping": {{"variable": "c"}}}}}}}},
    "simulation": {{"end_time": 0.01, "step": 0.01}},
    "variables": {{"m": {{"start": 2, "lower": 1, "upper": 9}},
                   "k": {{"start": 800, "lower": 1, "upper": 9999}},
                   "c": {{"start": {}, "lower": 0, "upper": 999}}}},
    "responses": {{"zeta": {{"type": "damping-ratio"}}, "first": {{"type": "damping-ratio", "mode": 1}},
                   "rate": {{"type": "growth-rate"}}}}}})",
                              damping));
}

/// ζ = c/(2√(km)), and the motion decays as exp(−c t/(2m)).
TEST(DampedMode, OfAMassOnASpringIsTheClosedForm) {
  const double m = 2.0, k = 800.0, c = 8.0, zeta = c / (2.0 * std::sqrt(k * m));
  const Found found = oscillator(c);
  EXPECT_NEAR(found.values(0), zeta, 1e-9);
  EXPECT_NEAR(found.values(1), zeta, 1e-9);
  EXPECT_NEAR(found.values(2), -c / (2.0 * m), 1e-8);
  const Eigen::RowVector3d of_ratio(-zeta / (2.0 * m), -zeta / (2.0 * k), zeta / c);
  const Eigen::RowVector3d of_rate(c / (2.0 * m * m), 0.0, -1.0 / (2.0 * m));
  EXPECT_LT((found.gradients.row(0) - of_ratio).norm(), 1e-7);
  EXPECT_LT((found.gradients.row(2) - of_rate).norm(), 1e-6);
}

/// Beyond c = 2√(km) = 80 N s/m nothing vibrates: s = −(c ∓ √(c² − 4 k m))/(2m).
TEST(DampedMode, WithoutVibrationHasARateAndNoRatio) {
  EXPECT_THROW(oscillator(100.0), SimulationError);
}

/// A cantilever whose damping goes with its stiffness, C = β K: ζ = β ω/2 of each mode, and the first
/// decays most slowly, with β ω²/2; so do their derivatives follow from those of the frequency.
TEST(DampedMode, OfACantileverWithDampingByStiffnessFollowsFromItsFrequencies) {
  constexpr double beta = 1e-4;
  const Found found = found_of(R"({"scene": {"gravity": [0, 0, 0],
      "bodies": {"b": {"type": "beam", "from": [0, 0, 0], "to": [0.8, 0, 0], "material": "steel",
        "section": {"type": "rectangle", "width": {"variable": "w"}, "height": {"variable": "h"}},
        "elements": 4, "damping": {"stiffness": 1e-4}}},
      "joints": {"c": {"type": "fixed", "bodies": ["ground", "b"], "at": [0, 0, 0]}}},
    "simulation": {"end_time": 1e-3, "step": 1e-3},
    "variables": {"w": {"start": 0.012, "lower": 0.001, "upper": 0.1},
                  "h": {"start": 0.02, "lower": 0.001, "upper": 0.1}},
    "responses": {"f2": {"type": "frequency", "mode": 2}, "z2": {"type": "damping-ratio", "mode": 2},
                  "fz": {"type": "frequency", "direction": "z"},
                  "rate": {"type": "growth-rate", "direction": "z"}}})");
  const double second = found.values(0), lowest = found.values(2);
  // ζ of the damped frequency: ω_d = ω √(1 − ζ²) changes no order.
  EXPECT_NEAR(found.values(1) / (0.5 * beta * second), 1.0, 1e-7);
  EXPECT_NEAR(found.values(3) / (-0.5 * beta * lowest * lowest), 1.0, 1e-7);
  EXPECT_LT((found.gradients.row(1) / (0.5 * beta) - found.gradients.row(0)).norm(),
            1e-5 * found.gradients.row(0).norm());
  EXPECT_LT((found.gradients.row(3) / (-beta * lowest) - found.gradients.row(2)).norm(),
            1e-5 * found.gradients.row(2).norm());
}

/// Beck's column with damping by stiffness, pressed along its tip by p EI/L²: without damping it
/// flutters from p = 20.05 on, with a little from 10.94 (Bolotin, Nonconservative Problems of the Theory
/// of Elastic Stability, 1963).
double growth_of_column(double p, double damping) {
  constexpr double stiffness = 7e10 * 0.03 * 1e-6 / 12;
  return found_of(fmt::format(R"({{"scene": {{"gravity": [0, 0, 0],
      "materials": {{"m": {{"young": 7e10, "poisson": 0.3, "density": 2700}}}},
      "bodies": {{"c": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "m",
        "section": {{"type": "rectangle", "width": 0.03, "height": 0.01}}, "elements": 10,
        "damping": {{"stiffness": {}}}}}}},
      "joints": {{"wall": {{"type": "fixed", "bodies": ["ground", "c"], "at": [0, 0, 0]}}}},
      "loads": {{"P": {{"type": "force", "body": "c", "at": [1, 0, 0], "direction": [-1, 0, 0],
        "follows": true, "value": {{"type": "table", "times": [-1, 0], "values": [{}, {}]}}}}}}}},
    "simulation": {{"end_time": 1e-3, "step": 1e-3}},
    "responses": {{"rate": {{"type": "growth-rate", "direction": "y"}}}}}})",
                              damping, p * stiffness, p * stiffness))
      .values(0);
}

TEST(DampedMode, OfBecksColumnGrowsBeyondItsCriticalLoads) {
  EXPECT_LT(growth_of_column(19.9, 0.0), 1e-3);
  EXPECT_GT(growth_of_column(20.2, 0.0), 1.0);
  EXPECT_LT(growth_of_column(10.8, 1e-5), 0.0);
  EXPECT_GT(growth_of_column(11.1, 1e-5), 0.0);
}

}  // namespace
}  // namespace pleuel::test::damped_mode_test
