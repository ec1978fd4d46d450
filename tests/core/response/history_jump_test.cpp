/// Peaks beside jumps, and ranges that end with one.

#include "core/response/history_jump.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/response/reduction.hpp"

namespace pleuel::test::history_jump_test {
namespace {

Eigen::VectorXd instants(int count) {
  return Eigen::VectorXd::LinSpaced(count, 0.0, 0.01 * (count - 1));
}

/// A force 20 that friction of 20 is added to until it turns round: it does not come near 45, which
/// is what a parabola through 40, 40 and 0 makes of it.
TEST(HistoryJump, OfFrictionThatTurnsRoundHasNoPeakAboveItsSamples) {
  Eigen::MatrixXd values(1, 20);
  for (int i = 0; i < 20; ++i) values(0, i) = 20.0 + (i < 10 ? 20.0 : -20.0);
  EXPECT_TRUE(jumps_beside(instants(20), values, 0, 9));
  EXPECT_EQ(reduce(OverTime::max, instants(20), values).value, 40.0);
  for (const Eigen::Index end : {0, 19}) EXPECT_FALSE(jumps_beside(instants(20), values, 0, end));
  values(0, 10) = 20.0;  // an instant within the jump
  EXPECT_EQ(reduce(OverTime::max, instants(20), values).value, 40.0);
  values.reverseInPlace();
  EXPECT_EQ(reduce(OverTime::max, instants(20), values).value, 40.0);
}

/// At the first instant nothing moves, so that there is no friction yet.
TEST(HistoryJump, BehindTheFirstInstantIsSeen) {
  Eigen::MatrixXd values = Eigen::MatrixXd::Constant(1, 20, 40.0);
  values(0, 0) = 20.0;
  for (int i = 1; i < 20; ++i) values(0, i) -= 0.1 * i;
  EXPECT_EQ(reduce(OverTime::max, instants(20), values).value, 39.9);
}

/// Sines with 5.5 steps a period or more, wherever the peak lies between them, and bells with a
/// deviation of 1.2 steps.
TEST(HistoryJump, IsNoneInWhatIsSmooth) {
  for (const double steps : {5.5, 6.0, 7.0, 8.0, 22.0, 100.0}) {
    for (double phase = 0.0; phase < 1.0; phase += 0.1) {
      Eigen::MatrixXd values(1, 200);
      for (int i = 0; i < 200; ++i) {
        values(0, i) = std::cos(2.0 * std::numbers::pi * (i + phase) / steps);
      }
      const double found = reduce(OverTime::max, instants(200), values).value;
      // Of the parabola, at most (remainder of interpolation); of the samples it is (π/n)²/2.
      const double most = std::pow(2.0 * std::numbers::pi / steps, 4) / 32.0;
      EXPECT_NEAR(found, 1.0, most + 1e-12) << steps << " " << phase;
      const Eigen::Index middle = std::lround(std::round(100.0 / steps) * steps - phase);
      EXPECT_FALSE(jumps_beside(instants(200), values, 0, middle)) << steps << " " << phase;
    }
  }
  for (double phase = -0.5; phase <= 0.5; phase += 0.1) {
    Eigen::MatrixXd values(1, 41);
    for (int i = 0; i < 41; ++i)
      values(0, i) = std::exp(-0.5 * std::pow((i - 20 + phase) / 1.2, 2));
    EXPECT_FALSE(jumps_beside(instants(41), values, 0, 20)) << phase;
  }
}

/// At a load that falls from 10 to 1 at the instant 10 the sample is 5.5: windows see their own
/// side, with derivatives of the samples that it is made from.
TEST(HistoryJump, AtTheEndOfARangeCountsFromWithin) {
  const auto value = [](int i) { return (i < 10 ? 10.0 : 1.0) + 0.01 * i; };
  Eigen::MatrixXd values(1, 21);
  for (int i = 0; i < 21; ++i) values(0, i) = value(i);
  values(0, 10) = 5.6;
  BrokenInstants breaks(21, false);
  breaks[10] = true;
  const Eigen::VectorXd time = instants(21);
  const Reduction before = reduce(OverTime::final, time, values, {0, 10}, breaks);
  EXPECT_NEAR(before.value, 10.1, 1e-12);
  double sum = 0.0;
  for (const Sample& sample : before.samples) sum += sample.weight * values(0, sample.step);
  EXPECT_NEAR(sum, before.value, 1e-12);
  EXPECT_NEAR(reduce(OverTime::max, time, values, {0, 10}, breaks).value, 10.1, 1e-12);
  EXPECT_NEAR(reduce(OverTime::min, time, values, {10, 20}, breaks).value, 1.1, 1e-12);
  EXPECT_NEAR(reduce(OverTime::mean, time, values, {10, 20}, breaks).value, 1.15, 1e-12);
  double lowest = 100.0;
  for (const Reduction& one : reduce_windows(OverTime::min, time, values, 3, {10, 20}, breaks)) {
    lowest = std::min(lowest, one.value);
  }
  EXPECT_NEAR(lowest, 1.1, 1e-12);
  // Elsewhere, and without a break, it is a sample like others.
  EXPECT_NEAR(reduce(OverTime::final, time, values, {0, 10}).value, 5.6, 1e-12);
  EXPECT_NEAR(reduce(OverTime::max, time, values, {0, 20}, breaks).value, 10.09, 1e-12);
}

}  // namespace
}  // namespace pleuel::test::history_jump_test
