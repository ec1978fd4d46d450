#include "core/response/reduction.hpp"

#include <algorithm>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "tests/support/parameter_name.hpp"

namespace pleuel::test::reduction_test {
namespace {

constexpr int steps = 40;
const Eigen::VectorXd grid = Eigen::VectorXd::LinSpaced(steps + 1, 0.0, 0.2);

Eigen::MatrixXd sampled(const std::function<double(double)>& f) {
  return grid.unaryExpr([&f](double t) { return f(t); }).transpose();
}

TEST(Reduction, FindsThePeakOfAParabolaBetweenTheSteps) {
  const auto y = sampled([](double t) { return 3.0 - 70.0 * (t - 0.0831) * (t - 0.0831); });
  EXPECT_NEAR(reduce(OverTime::max, grid, y).value, 3.0, 1e-14);
  EXPECT_NEAR(reduce(OverTime::min, grid, -y).value, -3.0, 1e-14);
  EXPECT_NEAR(reduce(OverTime::max_abs, grid, -y).value, 3.0, 1e-14);
  EXPECT_NEAR(reduce(OverTime::max_abs, grid, y).value, 3.0, 1e-14);
}

/// The same between steps of different sizes, with the derivatives of the height as weights.
TEST(Reduction, FindsThePeakOfAParabolaBetweenUnequalSteps) {
  Eigen::VectorXd time(5);
  time << 0.0, 0.04, 0.08, 0.09, 0.1;
  const Eigen::MatrixXd y = (3.0 - 70.0 * (time.array() - 0.0811).square()).matrix().transpose();
  const Reduction peak = reduce(OverTime::max, time, y);
  EXPECT_NEAR(peak.value, 3.0, 1e-14);
  ASSERT_EQ(peak.samples.size(), 3U);
  for (const Sample& sample : peak.samples) {
    const double h = 1e-6;
    Eigen::MatrixXd up = y, down = y;
    up(0, sample.step) += h;
    down(0, sample.step) -= h;
    const double slope =
        (reduce(OverTime::max, time, up).value - reduce(OverTime::max, time, down).value) / (2 * h);
    EXPECT_NEAR(sample.weight, slope, 1e-8);
  }
}

TEST(Reduction, TakesAPeakAtTheEndsAsItIs) {
  EXPECT_EQ(reduce(OverTime::max, grid, sampled([](double t) { return 2 - t; })).value, 2.0);
  EXPECT_EQ(reduce(OverTime::max, grid, sampled([](double t) { return t; })).value, 0.2);
  EXPECT_EQ(reduce(OverTime::min, grid, sampled([](double t) { return t - 1; })).value, -1.0);
  EXPECT_EQ(reduce(OverTime::max, grid, sampled([](double) { return -4.0; })).value, -4.0);
}

/// ∫ sin²: the trapezoidal rule is exact for trigonometric polynomials over whole periods.
TEST(Reduction, AveragesByTheTrapezoidalRule) {
  const auto y = sampled([](double t) { return 1.5 + std::sin(2 * std::numbers::pi * t / 0.1); });
  EXPECT_NEAR(reduce(OverTime::mean, grid, y).value, 1.5, 1e-14);
  EXPECT_NEAR(reduce(OverTime::integral, grid, y).value, 0.3, 1e-14);
  EXPECT_NEAR(reduce(OverTime::rms, grid, y).value, std::sqrt(1.5 * 1.5 + 0.5), 1e-14);
  EXPECT_NEAR(reduce(OverTime::final, grid, y).value, 1.5, 1e-13);
}

class EveryReduction : public testing::TestWithParam<OverTime> {};

/// Weights are derivatives: against central differences of each sample of a wavy history, which for
/// peaks are those of the envelope theorem.
TEST_P(EveryReduction, HasTheDerivativesOfItsValueAsWeights) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-0.05, 0.05);
  Eigen::MatrixXd y = sampled([](double t) { return std::sin(31 * t) - 0.4 + 2 * t; });
  for (double& entry : y.reshaped()) entry += 0.1 * uniform(random);
  const Reduction at = reduce(GetParam(), grid, y);
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(steps + 1);
  for (const Sample& sample : at.samples) weights(sample.step) += sample.weight;
  for (int i = 0; i <= steps; ++i) {
    const double h = 1e-5;
    Eigen::MatrixXd up = y, down = y;
    up(0, i) += h;
    down(0, i) -= h;
    const double slope =
        (reduce(GetParam(), grid, up).value - reduce(GetParam(), grid, down).value) / (2 * h);
    EXPECT_NEAR(weights(i), slope, 1e-7) << "sample " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryReduction,
                         testing::Values(OverTime::max, OverTime::min, OverTime::max_abs,
                                         OverTime::rms, OverTime::mean, OverTime::integral,
                                         OverTime::final),
                         named_by([](OverTime kind) {
                           switch (kind) {
                             case OverTime::max:
                               return "max";
                             case OverTime::min:
                               return "min";
                             case OverTime::max_abs:
                               return "max_abs";
                             case OverTime::rms:
                               return "rms";
                             case OverTime::mean:
                               return "mean";
                             case OverTime::integral:
                               return "integral";
                             default:
                               return "final";
                           }
                         }));

TEST(Reduction, TakesTheHighestChannel) {
  Eigen::MatrixXd y(2, steps + 1);
  y.row(0) = sampled([](double t) { return 1.0 - 50 * (t - 0.04) * (t - 0.04); });
  y.row(1) = sampled([](double t) { return 1.2 - 50 * (t - 0.151) * (t - 0.151); });
  const Reduction at = reduce(OverTime::max, grid, y);
  EXPECT_NEAR(at.value, 1.2, 1e-14);
  for (const Sample& sample : at.samples) EXPECT_EQ(sample.channel, 1);
  EXPECT_TRUE(at.ties.empty());
}

TEST(Reduction, TellsPeaksOfNearlyTheSameHeight) {
  const auto y = sampled([](double t) { return std::sin(2 * std::numbers::pi * t / 0.1); });
  const Reduction twice = reduce(OverTime::max, grid, y);  // two equal peaks
  ASSERT_FALSE(twice.ties.empty());
  EXPECT_NEAR(std::abs(twice.ties.front().time - twice.ties.front().other_time), 0.1, 1e-12);
  const Reduction both = reduce(OverTime::max_abs, grid, y);
  ASSERT_FALSE(both.ties.empty());
  EXPECT_NEAR(both.ties.front().gap, 0.0, 1e-9);
  const auto damped =
      sampled([](double t) { return std::exp(-t) * std::sin(2 * std::numbers::pi * t / 0.1); });
  EXPECT_TRUE(reduce(OverTime::max, grid, damped).ties.empty());
}

/// A thousandth parts peaks that tie from others.
TEST(Reduction, TellsPeaksThatAreLowerByAThousandth) {
  const auto second_lower_by = [](double gap) {
    return sampled([gap](double t) {
      const double height = t < 0.1 ? 1.0 : 1.0 - gap;
      return height * std::sin(2 * std::numbers::pi * t / 0.1);
    });
  };
  const Reduction tied = reduce(OverTime::max, grid, second_lower_by(0.95e-3));
  ASSERT_FALSE(tied.ties.empty());
  EXPECT_NEAR(tied.ties.front().gap, 0.95e-3, 1e-6);
  EXPECT_TRUE(reduce(OverTime::max, grid, second_lower_by(1.05e-3)).ties.empty());
}

/// Every period has a broad peak of height 1 and a sharp one that is lower by 0.05 %: between them
/// the maximum has a kink. The more periods, the more repetitions of the broad one are closer.
TEST(Reduction, TellsTheOtherPeakOfAPeriodHoweverManyPeriodsThereAre) {
  for (const int periods : {2, 5, 20, 200, 3000}) {
    constexpr int steps_of_period = 100;
    const int last = periods * steps_of_period;
    const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(last + 1, 0.0, periods);
    Eigen::MatrixXd y(1, last + 1);
    for (int i = 0; i <= last; ++i) {
      // The steps hit each period elsewhere.
      const double phase = time(i) + 0.37e-2 * std::floor(time(i)) / periods;
      const double t = phase - std::floor(phase);
      const double broad = 1.0 - 20.0 * std::pow(t - 0.3, 2);
      const double sharp = 0.9995 - 300.0 * std::pow(t - 0.7, 2);
      y(0, i) = std::max({0.0, broad, sharp});
    }
    const Reduction reduction = reduce(OverTime::max, time, y);
    const auto is_sharp = [](const PeakTie& tie) {
      return std::abs(tie.other_time - std::floor(tie.other_time) - 0.7) < 0.01;
    };
    EXPECT_TRUE(std::any_of(reduction.ties.begin(), reduction.ties.end(), is_sharp)) << periods;
    ASSERT_FALSE(reduction.ties.empty());
    EXPECT_FALSE(is_sharp(reduction.ties.front())) << periods;  // the closest one is a repetition
  }
}

/// Instants of later periods are sums: 0.1 + 0.2 is not 0.3.
TEST(BrokenInstants, AreThereButForRoundOff) {
  const Eigen::Vector4d time(0.0, 0.1, 0.1 + 0.2, 0.4);
  ASSERT_NE(time(2), 0.3);
  EXPECT_EQ(instants_at({0.3}, time), BrokenInstants({false, false, true, false}));
  EXPECT_EQ(instants_at({0.29, 0.4, 0.5}, time), BrokenInstants({false, false, false, true}));
  EXPECT_TRUE(instants_at({}, time).empty());
}

}  // namespace
}  // namespace pleuel::test::reduction_test
