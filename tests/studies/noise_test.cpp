#include "studies/noise.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/response/analysis.hpp"
#include "tests/studies/quick_problem.hpp"

namespace pleuel::test::noise_test {
namespace {

constexpr int points = 8;  // as many as response_noise() uses

/// exp(t) at t = 0, h, 2 h … plus noise that is uniform within ± √3 σ, so that its deviation is σ.
Eigen::VectorXd noisy_exponential(double spacing, double deviation, std::mt19937& engine) {
  Eigen::VectorXd values(points);
  for (int i = 0; i < points; ++i) {
    const double unit = 2.0 * static_cast<double>(engine()) / std::mt19937::max() - 1.0;
    values(i) = std::exp(spacing * i) + std::sqrt(3.0) * deviation * unit;
  }
  return values;
}

/// Moré & Wild call an estimate reliable that is within a factor of 4, and find that of 7 … 9
/// points so in nearly all cases.
TEST(Noise, OfKnownDeviationIsFoundWithinAFactorOfFour) {
  std::mt19937 engine;
  const double deviation = 1e-7;
  int reliable = 0;
  for (int k = 0; k < 200; ++k) {
    const double ratio = noise_of(noisy_exponential(1e-4, deviation, engine)) / deviation;
    if (ratio > 0.25 && ratio < 4.0) ++reliable;
  }
  EXPECT_GE(reliable, 190);
}

/// Many points tell it better: differences of n numbers have it to 1/√n, 5 % of 400.
TEST(Noise, OfManyPointsIsTheirDeviation) {
  std::mt19937 engine;
  Eigen::VectorXd values(400);
  for (double& value : values) {
    value = 2.0 * static_cast<double>(engine()) / std::mt19937::max() - 1.0;
  }
  EXPECT_NEAR(noise_of(values) * std::sqrt(3.0), 1.0, 0.15);
}

/// The first difference of exp over h = 1e-2 is 1e-2, the fifth 1e-10: curvature is no noise.
TEST(Noise, OfASmoothFunctionIsItsHighDifferences) {
  std::mt19937 engine;
  EXPECT_LT(noise_of(noisy_exponential(1e-2, 0.0, engine)), 1e-10);
}

TEST(Noise, OfAConstantIsZero) {
  EXPECT_EQ(noise_of(Eigen::VectorXd::Constant(points, 3.7)), 0.0);
}

/// Newton's method with a tolerance of 1e-4 leaves more than one with 1e-10, in every response of
/// the motion; the mass (the first response) needs no simulation and has round-off only.
TEST(Noise, GrowsWithTheToleranceOfNewtonsMethod) {
  const ProblemFile tight = test::quick_problem({"/simulation/step=1 ms"});
  const ProblemFile loose =
      test::quick_problem({"/simulation/step=1 ms", "/simulation/newton_tolerance=1e-2"});
  const Eigen::VectorXd x = start_design(tight);
  const Eigen::VectorXd small = response_noise(tight, x).floor();
  const Eigen::VectorXd large = response_noise(loose, x).floor();
  EXPECT_LT(large(0), 1e-15 * 10.0);  // kg, of a mass of about 1.7
  for (Eigen::Index i = 1; i < small.size(); ++i) {
    EXPECT_GT(large(i), 100.0 * small(i)) << tight.responses[i].name;
  }
}

TEST(Noise, DoesNotDependOnTheThreads) {
  const ProblemFile problem = test::quick_problem();
  const Eigen::VectorXd x = start_design(problem);
  EXPECT_EQ(response_noise(problem, x, 1).floor(), response_noise(problem, x, 2).floor());
}

}  // namespace
}  // namespace pleuel::test::noise_test
