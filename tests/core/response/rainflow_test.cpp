#include "core/response/rainflow.hpp"

#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/response/fatigue_damage.hpp"
#include "core/scene/problem_reader.hpp"
#include "sensitivity/gradients.hpp"

namespace {

using namespace pleuel;

/// ASTM E1049-85 (2017), figure 6, the example of 5.4.4: peaks and valleys A … I; one cycle EF of
/// range 4, and half cycles AB 3, BC 4, CD 8, DG 9, GH 8, HI 6.
TEST(Rainflow, CountsTheExampleOfTheStandard) {
  const std::vector<double> turning = {-2, 1, -3, 5, -1, 3, -4, 4, -2};
  const std::vector<std::array<double, 3>> expected = {
      {0, 1, 0.5}, {1, 2, 0.5}, {4, 5, 1.0}, {2, 3, 0.5}, {3, 6, 0.5}, {6, 7, 0.5}, {7, 8, 0.5}};
  const std::vector<CountedCycle> found = count_rainflow(turning);
  ASSERT_EQ(found.size(), expected.size());
  std::map<double, double> counts;  // by range
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(static_cast<double>(found[i].from), expected[i][0]);
    EXPECT_EQ(static_cast<double>(found[i].to), expected[i][1]);
    EXPECT_EQ(found[i].count, expected[i][2]);
    counts[std::abs(turning[found[i].to] - turning[found[i].from])] += found[i].count;
  }
  EXPECT_EQ(counts, (std::map<double, double>{{3, 0.5}, {4, 1.5}, {6, 0.5}, {8, 1.0}, {9, 0.5}}));
}

/// Every range between neighbours is counted: of n turning points n − 1 halves.
TEST(Rainflow, CountsEverythingOnce) {
  std::vector<double> turning;
  for (int i = 0; i < 200; ++i) turning.push_back((i % 2 == 0 ? 1.0 : -1.0) * (1 + (i * 37) % 83));
  double halves = 0.0;
  for (const CountedCycle& cycle : count_rainflow(turning)) halves += 2.0 * cycle.count;
  EXPECT_EQ(halves, 199.0);
}

/// The same history as samples with steps between them that are no turning points: Basquin's line
/// with k = 3 and no mean stress: D = Σ n · 2 (range/2/s)³. Peaks are samples: triangles have breaks.
TEST(Damage, IsTheSumOverTheCountedCycles) {
  const std::vector<double> turning = {-2, 1, -3, 5, -1, 3, -4, 4, -2};
  Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(33, 0.0, 32.0);
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(2, 33);
  BrokenInstants breaks(33, false);
  for (Eigen::Index i = 0; i < 33; ++i) {
    const auto k = static_cast<std::size_t>(i / 4);
    const double share = static_cast<double>(i % 4) / 4.0;
    const double next = k + 1 < turning.size() ? turning[k + 1] : 0.0;
    values(0, i) = ((1.0 - share) * turning[k] + share * next) / 10.0;
    breaks[static_cast<std::size_t>(i)] = i % 4 == 0;
  }
  double expected = 0.0;
  for (const auto& [range, count] : {std::pair(3, 0.5), {4, 1.5}, {6, 0.5}, {8, 1.0}, {9, 0.5}}) {
    expected += count * 2.0 * std::pow(range / 20.0, 3);
  }
  EXPECT_NEAR(
      reduce_damage(FatigueCriterion::goodman, 3.0, time, values, whole_range(time), breaks).value,
      expected, 1e-15);
}

Eigen::MatrixXd waves(const Eigen::VectorXd& time) {
  Eigen::MatrixXd values(4, time.size());
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    const double t = time(i);
    values(0, i) = 0.1 + 0.3 * std::sin(7.0 * t) + 0.15 * std::sin(19.0 * t + 0.5);
    values(2, i) = 0.2 * std::sin(3.0 * t + 0.4) - 0.1 * std::cos(11.0 * t);
  }
  values.row(1) = 0.6 * values.row(0);
  values.row(3) = 0.6 * values.row(2);
  return values;
}

/// Central differences: 1e-6 of the change, errors of 1e-12 and round-off of 1e-10.
TEST(Damage, IsLinearisedInItsSamples) {
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(121, 0.0, 3.0);
  const Eigen::MatrixXd values = waves(time);
  Eigen::MatrixXd change(4, time.size());
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    change(0, i) = std::cos(5.0 * time(i));
    change(2, i) = std::sin(5.0 * time(i));
  }
  change.row(1) = 0.6 * change.row(0) + 0.1 * values.row(0);
  change.row(3) = 0.6 * change.row(2);
  for (const FatigueCriterion criterion : {FatigueCriterion::goodman, FatigueCriterion::gerber}) {
    const auto at = [&](double s) {
      return reduce_damage(criterion, 5.0, time, values + s * change, whole_range(time)).value;
    };
    const Reduction found = reduce_damage(criterion, 5.0, time, values, whole_range(time));
    double slope = 0.0;
    for (const Sample& sample : found.samples) {
      slope += sample.weight * change(sample.channel, sample.step);
    }
    ASSERT_GT(found.value, 0.0);
    EXPECT_NEAR((at(1e-6) - at(-1e-6)) / 2e-6 / slope, 1.0, 1e-7);
  }
}

/// A light bar that is pulled by F₀ + F₁ cos ωt for four periods: one whole cycle less than the
/// periods closes, the rest are halves; all have one range: D = 4 · 2 (σ_ar/s)^k with Goodman's
/// σ_ar = σ_a/(1 − σ_m/S_u).
TEST(Damage, OfAPulledBarIsThatOfItsCycles) {
  const ProblemFile problem = read_problem_text(
      R"j({"scene": {"gravity": [0, 0, 0],
    "materials": {"light": {"young": "200 GPa", "poisson": 0.3, "density": 1,
      "ultimate_strength": "400 MPa", "fatigue_strength": "900 MPa", "fatigue_exponent": 8}},
    "bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": [0.5, 0, 0], "elements": 1,
      "material": "light",
      "section": {"type": "rectangle", "width": {"variable": "width"}, "height": "10 mm"}}},
    "joints": {"wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}},
    "loads": {"pull": {"type": "force", "body": "bar", "at": [0.5, 0, 0], "direction": [1, 0, 0],
                       "value": "20 kN"},
              "shake": {"type": "force", "body": "bar", "at": [0.5, 0, 0], "direction": [1, 0, 0],
                        "value": {"type": "harmonic", "amplitude": "40 kN", "frequency": "10 Hz",
                                  "phase": "90 deg"}}}},
  "effects": {"geometric_stiffening": "off"},
  "simulation": {"end_time": "0.4 s", "step": "1 ms", "initial_state": "quasi-static",
                 "newton_tolerance": 1e-13},
  "variables": {"width": {"start": "20 mm", "lower": "2 mm", "upper": "50 mm"}},
  "responses": {"damage": {"type": "fatigue-damage", "body": "bar", "criterion": "goodman"}}})j",
      "bar.json");
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const auto damage = [](double across) {
    const double area = across * 0.01, full = 40e3 / area / (1.0 - 20e3 / area / 400e6);
    return 4 * 2 * std::pow(full / 900e6, 8);
  };
  // Eight times the 1e-5 of vibrations in the stress.
  EXPECT_NEAR(analysis->reductions[0].value / damage(0.02), 1.0, 1e-4);
  const double slope = (damage(0.02 + 1e-7) - damage(0.02 - 1e-7)) / 2e-7;
  for (const GradientMethod method : {GradientMethod::direct, GradientMethod::adjoint}) {
    EXPECT_NEAR(gradients(problem, x, *analysis, method)(0, 0) / slope, 1.0, 1e-3);
  }
}

}  // namespace
