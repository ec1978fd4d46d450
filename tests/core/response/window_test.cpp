#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/analysis.hpp"
#include "tests/core/response/response_samples.hpp"

namespace pleuel::test::window_test {
namespace {

using namespace response_samples;

constexpr int steps = 40;
const Eigen::VectorXd grid = Eigen::VectorXd::LinSpaced(steps + 1, 0.0, 0.2);

Eigen::MatrixXd sampled(double (*f)(double)) {
  return grid.unaryExpr([f](double t) { return f(t); }).transpose();
}

TEST(Window, HoldsBothItsEnds) {
  const StepRange range = steps_between(grid, 0.05, 0.15);
  EXPECT_EQ(range.first, 10);
  EXPECT_EQ(range.last, 30);
  EXPECT_EQ(steps_between(grid, {}, {}).steps(), steps + 1);
  EXPECT_EQ(steps_between(grid, 0.151, {}).first, 31);
  EXPECT_LE(steps_between(grid, 0.151, 0.154).steps(), 0);
}

/// A peak beyond the window counts with the sample at its edge only, without a parabola.
TEST(Window, TakesPeaksAtItsEdgesAsSamples) {
  const auto y = sampled([](double t) { return 3.0 - 70.0 * (t - 0.1) * (t - 0.1); });
  const Reduction before = reduce(OverTime::max, grid, y, steps_between(grid, {}, 0.08));
  EXPECT_EQ(before.value, y(0, 16));
  ASSERT_EQ(before.samples.size(), 1U);
  EXPECT_EQ(before.samples[0].step, 16);
  const Reduction after = reduce(OverTime::max, grid, y, steps_between(grid, 0.12, {}));
  EXPECT_EQ(after.value, y(0, 24));
  const Reduction around = reduce(OverTime::max, grid, y, steps_between(grid, 0.08, 0.12));
  EXPECT_NEAR(around.value, 3.0, 1e-14);
}

/// Of 1 + 2t the trapezoidal rule is exact: over [0.05, 0.15] the mean is 1.2.
TEST(Window, RestrictsAveragesAndTheEnd) {
  const auto y = sampled([](double t) { return 1.0 + 2.0 * t; });
  const StepRange range = steps_between(grid, 0.05, 0.15);
  EXPECT_NEAR(reduce(OverTime::mean, grid, y, range).value, 1.2, 1e-14);
  EXPECT_NEAR(reduce(OverTime::integral, grid, y, range).value, 0.12, 1e-14);
  EXPECT_NEAR(reduce(OverTime::final, grid, y, range).value, 1.3, 1e-14);
  // ∫(1 + 2t)² = 1.2² + (0.1²/12) 4, and h²/12 ∫ y²″ = h²/12 · 8 of the rule
  const double square = 1.44 + 0.01 / 3 + 8 * 0.005 * 0.005 / 12;
  EXPECT_NEAR(reduce(OverTime::rms, grid, y, range).value, std::sqrt(square), 1e-13);
}

/// mean, integral, rms and the end take the largest channel.
TEST(Reduction, OfAveragesTakesTheLargestChannel) {
  Eigen::MatrixXd y(2, steps + 1);
  y.row(0).setConstant(-3.0);
  y.row(1).setConstant(2.0);
  EXPECT_NEAR(reduce(OverTime::mean, grid, y).value, 2.0, 1e-14);
  EXPECT_NEAR(reduce(OverTime::final, grid, y).value, 2.0, 1e-14);
  for (const Sample& sample : reduce(OverTime::mean, grid, y).samples) {
    EXPECT_EQ(sample.channel, 1);
  }
}

/// The highest stretch is the reduction of the window, however many stretches there are.
TEST(Window, IsTheHighestOfItsStretches) {
  const auto y = sampled([](double t) { return std::sin(70.0 * t) - 3.0 * t; });
  const StepRange range = steps_between(grid, 0.03, 0.17);
  const double whole = reduce(OverTime::max, grid, y, range).value;
  for (int windows : {1, 3, 7, 60}) {
    const auto stretches = reduce_windows(OverTime::max, grid, y, windows, range);
    EXPECT_EQ(stretches.size(), static_cast<std::size_t>(windows));
    double highest = -1e9;
    for (const Reduction& stretch : stretches) highest = std::max(highest, stretch.value);
    EXPECT_EQ(highest, whole) << windows;
  }
}

ProblemFile falling(double from, double to) {
  ProblemFile problem;
  problem.scene.gravity = {0.0, -9.81, 0.0};
  problem.scene.bodies = {{"mass", PointMass{{0.0, 0.0, 0.0}, 1.0}}};
  problem.simulation.end_time = 0.1;
  problem.simulation.step = 1e-3;
  ResponseSettings speed;
  speed.name = "speed";
  speed.type = ResponseType::velocity;
  speed.bodies = {"mass"};
  speed.direction = 1;
  speed.over_time = OverTime::min;
  speed.from = from;
  speed.to = to;
  problem.responses = {speed};
  return problem;
}

/// v = −g t, which generalized-α follows exactly.
TEST(Window, IsOfTheResponse) {
  EXPECT_NEAR(analyze(falling(0.02, 0.07), {})->reductions[0].value, -9.81 * 0.07, 1e-12);
}

/// Steps end where it does, however long they are.
TEST(Window, HasAnInstantAtItsEnds) {
  const auto analysis = analyze(falling(0.02037, 0.06961), {});
  EXPECT_NEAR(analysis->reductions[0].value, -9.81 * 0.06961, 1e-12);
  ProblemFile integral = falling(0.02037, 0.06961);
  integral.responses[0].over_time = OverTime::integral;
  // Of the trapezoidal rule, exact for a straight line.
  EXPECT_NEAR(analyze(integral, {})->reductions[0].value,
              -0.5 * 9.81 * (0.06961 * 0.06961 - 0.02037 * 0.02037), 1e-12);
}

TEST(Window, WithLessThanTwoStepsIsAnError) {
  try {
    analyze(falling(0.0201, 0.0202), {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "/responses/speed is reduced over a window of time with less than two steps; widen it or "
        "shorten the steps");
  }
}

}  // namespace
}  // namespace pleuel::test::window_test
