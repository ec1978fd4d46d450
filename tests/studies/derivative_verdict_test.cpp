#include <cmath>

#include <gtest/gtest.h>

#include "studies/derivative_check.hpp"

namespace pleuel::test::derivative_verdict_test {
namespace {

constexpr double place = 2.0;

/// Central differences of f(x) = x³ at 2, in error by one deviation of the noise of f, to
/// alternating sides: f' = 12, f = 8.
std::vector<CentralDifference> cubic_differences(double noise) {
  std::vector<CentralDifference> curve;
  double side = 1.0;
  for (const double step : {1e-5, 1e-4, 1e-6, 1e-3, 1e-7, 1e-2, 1e-8}) {
    const double delta = step * place;
    const double exact = 3.0 * place * place + delta * delta;  // of a cubic
    curve.push_back({step, exact + side * noise / (std::sqrt(2.0) * delta)});
    side = -side;
  }
  return curve;
}

DerivativeEvidence evidence(double derivative, double noise) {
  return {derivative, place, 8.0, noise, 0.0, false};
}

JudgedDerivative judged(double derivative, double noise) {
  return judge_derivative(evidence(derivative, noise), cubic_differences(noise));
}

TEST(DerivativeVerdict, OfTheRightDerivativeIsThatItAgrees) {
  const JudgedDerivative right = judged(12.0, 1e-13);
  EXPECT_EQ(right.verdict, DerivativeVerdict::agrees);
  // Truncation h² · 4/12 and noise 1e-13 / (√2 · 2 h · 12) are equal near h = 2e-5.
  EXPECT_EQ(right.step, 1e-5);
  EXPECT_LT(right.error, 1e-8);
}

TEST(DerivativeVerdict, CurveAscendsAndHasTheShapeOfAV) {
  const JudgedDerivative right = judged(12.0, 1e-13);
  ASSERT_EQ(right.curve.size(), 7u);
  for (std::size_t k = 1; k < right.curve.size(); ++k) {
    EXPECT_GT(right.curve[k].step, right.curve[k - 1].step);
    const bool falls = right.curve[k].error < right.curve[k - 1].error;
    EXPECT_EQ(falls, right.curve[k].step <= right.step) << right.curve[k].step;
  }
}

/// At a step of 1e-8 noise is as large as the error; the better steps show it all the same.
TEST(DerivativeVerdict, OfAWrongDerivativeIsNotExcusedByNoiseOfTheSmallestStep) {
  for (const double wrong : {1e-5, 1e-4, 1e-2, 2.0}) {
    EXPECT_EQ(judged(12.0 * (1.0 + wrong), 1e-12).verdict, DerivativeVerdict::differs) << wrong;
  }
  EXPECT_EQ(judged(-12.0, 1e-12).verdict, DerivativeVerdict::differs);
  EXPECT_EQ(judged(0.0, 1e-12).verdict, DerivativeVerdict::differs);
}

/// Noise of 1e-4 leaves 1e-4 / (√2 · 2e-3) = 0.035 of 12 uncertain even at a step of 1e-3.
TEST(DerivativeVerdict, OfARightDerivativeOfANoisyResponseIsNoise) {
  const JudgedDerivative right = judged(12.0, 1e-4);
  EXPECT_GT(right.error, 1e-6);
  EXPECT_EQ(right.verdict, DerivativeVerdict::noise);
  EXPECT_GT(right.resolution, 1e-4 / (std::sqrt(2.0) * 2e-3) / 12.0);
}

TEST(DerivativeVerdict, OfAWrongDerivativeOfANoisyResponseIsThatItDiffers) {
  EXPECT_EQ(judged(18.0, 1e-4).verdict, DerivativeVerdict::differs);
}

/// A response that is nothing but noise, as the drift of constraints that do not drift: its
/// derivative is as small as its value, differences are of the size of noise / step.
TEST(DerivativeVerdict, OfAResponseThatIsNoiseIsNoise) {
  const double noise = 1e-16;
  std::vector<CentralDifference> curve;
  for (const double step : {1e-3, 1e-4, 1e-5, 1e-6}) {
    curve.push_back({step, noise / (step * place)});
  }
  const DerivativeEvidence drift{3e-16, place, 2e-16, noise, 0.0, false};
  EXPECT_EQ(judge_derivative(drift, curve).verdict, DerivativeVerdict::noise);
}

/// What Newton's method leaves is smooth: it makes the derivative of f wrong by as much as f, at
/// every step alike.
TEST(DerivativeVerdict, CountsWhatNewtonsMethodLeavesOnceAtEveryStep) {
  DerivativeEvidence loose = evidence(12.0 + 1e-4, 1e-13);
  EXPECT_EQ(judge_derivative(loose, cubic_differences(1e-13)).verdict, DerivativeVerdict::differs);
  loose.remainder = 1e-4;
  EXPECT_EQ(judge_derivative(loose, cubic_differences(1e-13)).verdict, DerivativeVerdict::noise);
  loose.derivative = 12.0 + 1e-2;
  EXPECT_EQ(judge_derivative(loose, cubic_differences(1e-13)).verdict, DerivativeVerdict::differs);
}

/// Differences that do not settle, as next to peaks between steps of time: their scatter of 10 %
/// hides a part in ten thousand, but not a wrong term.
TEST(DerivativeVerdict, OfAWrongDerivativeIsNotExcusedByTruncation) {
  std::vector<CentralDifference> curve;
  double side = 1.0;
  for (const double step : {1e-6, 1e-5, 1e-4, 1e-3}) {
    curve.push_back({step, 12.0 * (1.0 + (step == 1e-4 ? 1e-4 : 0.1 * side))});
    side = -side;
  }
  EXPECT_EQ(judge_derivative(evidence(12.0, 1e-13), curve).verdict, DerivativeVerdict::noise);
  EXPECT_EQ(judge_derivative(evidence(12.3, 1e-13), curve).verdict, DerivativeVerdict::differs);
}

TEST(DerivativeVerdict, NextToAKinkIsThatItIsAKink) {
  DerivativeEvidence near_kink = evidence(13.0, 1e-13);
  near_kink.has_kink = true;
  EXPECT_EQ(judge_derivative(near_kink, cubic_differences(1e-13)).verdict, DerivativeVerdict::kink);
  near_kink.derivative = 12.0;  // not near enough to be seen
  EXPECT_EQ(judge_derivative(near_kink, cubic_differences(1e-13)).verdict,
            DerivativeVerdict::agrees);
}

TEST(DerivativeVerdict, DoesNotDependOnTheUnitOfTheVariable) {
  const double millimetres = 1e3;
  std::vector<CentralDifference> curve = cubic_differences(1e-4);
  for (CentralDifference& difference : curve) difference.value /= millimetres;
  DerivativeEvidence scaled = evidence(12.0 / millimetres, 1e-4);
  scaled.size *= millimetres;
  const JudgedDerivative here = judged(12.0, 1e-4), there = judge_derivative(scaled, curve);
  EXPECT_EQ(there.verdict, here.verdict);
  EXPECT_NEAR(there.error / here.error, 1.0, 1e-9);
}

}  // namespace
}  // namespace pleuel::test::derivative_verdict_test
