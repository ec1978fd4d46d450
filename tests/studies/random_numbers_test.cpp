#include <algorithm>
#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "studies/noise.hpp"

namespace pleuel::test::random_numbers_test {
namespace {

using pleuel::RandomNumbers;

/// The standard prescribes the 10000th number of mt19937_64 with the seed 5489.
TEST(RandomNumbers, AreThoseOfTheEngine) {
  RandomNumbers numbers(5489);
  for (int i = 1; i < 10000; ++i) numbers.uniform();
  EXPECT_NEAR(numbers.uniform(), 9981545732273789042.0 / 18446744073709551616.0, 1e-15);
}

/// Of N independent samples, a share below x scatters about Φ(x) by √(Φ(1 − Φ)/N); moments likewise
/// (that of the fourth by √(96/N)). Four such deviations.
TEST(RandomNumbers, AreNormal) {
  constexpr int samples = 200'000;
  RandomNumbers numbers(1);
  std::vector<double> x(samples);
  double mean = 0.0, square = 0.0, fourth = 0.0, neighbours = 0.0;
  for (int i = 0; i < samples; ++i) {
    const auto k = static_cast<std::size_t>(i);
    x[k] = numbers.normal();
    mean += x[k] / samples;
    square += x[k] * x[k] / samples;
    fourth += std::pow(x[k], 4) / samples;
    if (i > 0) neighbours += x[k] * x[k - 1] / samples;
  }
  const double scatter = 4.0 / std::sqrt(double(samples));
  EXPECT_NEAR(mean, 0.0, scatter);
  EXPECT_NEAR(square, 1.0, std::sqrt(2.0) * scatter);
  EXPECT_NEAR(fourth, 3.0, std::sqrt(96.0) * scatter);
  EXPECT_NEAR(neighbours, 0.0, scatter);
  for (const double quantile : {-3.0, -1.96, -1.0, -0.3, 0.0, 0.5, 1.5, 2.5}) {
    const double expected = 0.5 * std::erfc(-quantile / std::sqrt(2.0));
    const auto below =
        std::count_if(x.begin(), x.end(), [quantile](double value) { return value < quantile; });
    EXPECT_NEAR(double(below) / samples, expected, scatter * std::sqrt(expected * (1 - expected)))
        << quantile;
  }
}

}  // namespace
}  // namespace pleuel::test::random_numbers_test
