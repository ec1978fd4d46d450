#include <array>
#include <map>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/fatigue.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::rainflow_test {
namespace {

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

/// One turn of a motion that repeats itself, begun at any of its samples. Whole cycles by hand: of
/// 0, 6, 2, 4, −4, 1, −1 one each of the ranges 10 (6 … −4), 2 (2 … 4) and 2 (1 … −1).
TEST(Damage, OfAMotionThatRepeatsItselfDoesNotDependOnItsBeginning) {
  const std::vector<double> turn = {0, 6, 2, 4, -4, 1, -1};
  const auto samples = static_cast<Eigen::Index>(2 * turn.size());
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(samples + 1, 0.0, 14.0);
  const BrokenInstants breaks(static_cast<std::size_t>(samples + 1), true);
  const double expected = 2.0 * (std::pow(0.5, 3) + 2.0 * std::pow(0.1, 3));
  for (Eigen::Index shift = 0; shift < samples; ++shift) {
    Eigen::MatrixXd values = Eigen::MatrixXd::Zero(2, samples + 1);
    for (Eigen::Index i = 0; i <= samples; ++i) {
      const auto at = static_cast<std::size_t>((i + shift) % samples);
      const double here = turn[at / 2], next = turn[(at / 2 + 1) % turn.size()];
      values(0, i) = (at % 2 == 0 ? here : 0.5 * (here + next)) / 10.0;
    }
    const auto damage = [&](RangeEnds ends) {
      return reduce_damage(FatigueCriterion::goodman, 3.0, time, values, whole_range(time), breaks,
                           ends)
          .value;
    };
    EXPECT_NEAR(damage(RangeEnds::repeating), expected, 1e-15) << shift;
    EXPECT_LE(damage(RangeEnds::cut), expected * (1.0 + 1e-12)) << shift;
  }
}

/// Peaks between samples, also across the end of the turn: 2 (σ_a/σ_f')^k of each phase.
TEST(Damage, OfASineThatRepeatsItselfIsThatOfOneCycle) {
  for (const double phase : {0.0, 0.01, 0.7, 1.5707, 3.0}) {
    const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(101, 0.0, 2.0);
    Eigen::MatrixXd values = Eigen::MatrixXd::Zero(2, 101);
    for (Eigen::Index i = 0; i < 101; ++i) {
      values(0, i) = 0.3 * std::sin(std::numbers::pi * time(i) + phase);
    }
    values.col(100) = values.col(0);
    const double found = reduce_damage(FatigueCriterion::goodman, 4.0, time, values,
                                       whole_range(time), {}, RangeEnds::repeating)
                             .value;
    EXPECT_NEAR(found / (2.0 * std::pow(0.3, 4)), 1.0, 1e-6) << phase;
  }
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
  for (const auto& [criterion, ends] : {std::pair(FatigueCriterion::goodman, RangeEnds::cut),
                                        {FatigueCriterion::gerber, RangeEnds::cut},
                                        {FatigueCriterion::gerber, RangeEnds::repeating}}) {
    const auto reduced = [&, criterion = criterion, ends = ends](double s) {
      return reduce_damage(criterion, 5.0, time, values + s * change, whole_range(time), {}, ends);
    };
    const auto at = [&](double s) { return reduced(s).value; };
    const Reduction found = reduced(0.0);
    double slope = 0.0;
    for (const Sample& sample : found.samples) {
      slope += sample.weight * change(sample.channel, sample.step);
    }
    ASSERT_GT(found.value, 0.0);
    EXPECT_NEAR((at(1e-6) - at(-1e-6)) / 2e-6 / slope, 1.0, 1e-7);
  }
}

/// A light bar that is pulled by F₀ + F₁ sin(ωt + phase).
/// @param simulation  its time, step and start
ProblemFile pulled_bar(const std::string& simulation, const std::string& phase) {
  ProblemFile problem = problem_from(R"j({"scene": {"gravity": [0, 0, 0],
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
                                  "phase": ")j" +
                                     phase + R"j("}}}},
  "effects": {"geometric_stiffening": "off"},
  "simulation": {"newton_tolerance": 1e-13, )j" +
                                     simulation + R"j(},
  "variables": {"width": {"start": "20 mm", "lower": "2 mm", "upper": "50 mm"}},
  "responses": {"damage": {"type": "fatigue-damage", "body": "bar", "criterion": "goodman"}}})j");
  return problem;
}

/// Of a cycle: 2 (σ_ar/s)^k with Goodman's σ_ar = σ_a/(1 − σ_m/S_u).
double bar_damage(double width) {
  const double area = width * 0.01, full = 40e3 / area / (1.0 - 20e3 / area / 400e6);
  return 2.0 * std::pow(full / 900e6, 8);
}

void expect_damage(const ProblemFile& problem, double cycles) {
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  // Eight times the 1e-5 of vibrations in the stress.
  EXPECT_NEAR(analysis->reductions[0].value / (cycles * bar_damage(0.02)), 1.0, 1e-4);
  const double slope = cycles * (bar_damage(0.02 + 1e-7) - bar_damage(0.02 - 1e-7)) / 2e-7;
  for (const GradientMethod method : {GradientMethod::direct, GradientMethod::adjoint}) {
    EXPECT_NEAR(gradients(problem, x, *analysis, method)(0, 0) / slope, 1.0, 1e-3);
  }
}

/// Of four periods one whole cycle less closes, the rest are halves; all have one range.
TEST(Damage, OfAPulledBarIsThatOfItsCycles) {
  expect_damage(
      pulled_bar(R"("end_time": "0.4 s", "step": "1 ms", "initial_state": "quasi-static")",
                 "90 deg"),
      4.0);
}

/// The steady state of one period is one cycle, wherever it begins; so is a window of it.
TEST(Damage, OfASteadyStateIsThatOfAWholeCycle) {
  for (const char* phase : {"90 deg", "0 deg", "200 deg"}) {
    SCOPED_TRACE(phase);
    expect_damage(
        pulled_bar(R"("end_time": "0.1 s", "step": "1 ms", "initial_state": "periodic")", phase),
        1.0);
    ProblemFile window = pulled_bar(
        R"("end_time": "0.3 s", "step": "1 ms", "initial_state": {"type": "periodic", "period": "0.1 s"})",
        phase);
    window.responses[0].from = 0.05;
    window.responses[0].to = 0.25;
    expect_damage(window, 2.0);
  }
}

}  // namespace
}  // namespace pleuel::test::rainflow_test
