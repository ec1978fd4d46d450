/// Linear maps from what is observed to histories.

#include "core/response/history_map.hpp"

#include <memory>

#include <gmock/gmock.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"

namespace pleuel::test::history_map_test {
namespace {

const Eigen::VectorXd uneven{{0.0, 0.1, 0.3, 0.35, 0.6, 1.0}};
constexpr StepRange inner{2, 4};

/// A parabola goes through three instants.
TEST(RateMap, IsExactForParabolasWithUnevenSteps) {
  const Eigen::MatrixXd parabola =
      (3.0 + 2.0 * uneven.array() - 5.0 * uneven.array().square()).matrix().transpose();
  const Eigen::MatrixXd rate = RateMap().apply(uneven, {0, 5}, parabola);
  const Eigen::MatrixXd expected = (2.0 - 10.0 * uneven.array()).matrix().transpose();
  EXPECT_LE((rate - expected).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(RateMap, IsASlopeBetweenTwoInstants) {
  const Eigen::MatrixXd line{{1.0, 4.0}};
  const Eigen::MatrixXd rate = RateMap().apply(Eigen::Vector2d(0.0, 0.5), {0, 1}, line);
  EXPECT_EQ(rate, Eigen::MatrixXd::Constant(1, 2, 6.0));
}

/// The trapezoidal rule is exact for a rate that is linear in time: amount 1 + t² of the rate 2t; with
/// another 3 (t − t₀) of it, that is missing.
TEST(BalanceMap, IsWhatTheRateDoesNotMake) {
  const Eigen::ArrayXd t = uneven.array();
  Eigen::MatrixXd observed(2, uneven.size());
  observed << (1.0 + t.square() + 3.0 * t).matrix().transpose(), (2.0 * t).matrix().transpose();
  const Eigen::MatrixXd missing = BalanceMap().apply(uneven, inner, observed);
  const Eigen::MatrixXd expected = (3.0 * (t - t(inner.first))).matrix().transpose();
  EXPECT_LE((missing - expected).cwiseAbs().maxCoeff(), 1e-15);
}

class HistoryMaps : public testing::TestWithParam<bool> {
 protected:
  HistoryMaps() {
    if (GetParam()) {
      map_ = std::make_unique<RateMap>();
    } else {
      map_ = std::make_unique<BalanceMap>();
    }
  }

  std::unique_ptr<HistoryMap> map_;
};

/// What a sample of a history is made from says the same as the history.
TEST_P(HistoryMaps, TellWhatTheirSamplesAreMadeFrom) {
  const Eigen::MatrixXd observed = Eigen::MatrixXd::Random(4, uneven.size());
  const Eigen::MatrixXd history = map_->apply(uneven, inner, observed);
  for (int channel = 0; channel < int_size(history.col(0)); ++channel) {
    for (int step = 0; step < int_size(uneven); ++step) {
      std::vector<Sample> samples;
      map_->add_observed(uneven, inner, {step, channel, 2.0}, samples);
      double sum = 0.0;
      for (const Sample& sample : samples) {
        sum += sample.weight * observed(sample.channel, sample.step);
        EXPECT_THAT(map_->observed_channels(channel), testing::Contains(sample.channel));
      }
      EXPECT_NEAR(sum, 2.0 * history(channel, step), 1e-13) << channel << " " << step;
    }
  }
}

/// The channels of one channel of the history alone make it.
TEST_P(HistoryMaps, NeedNoOtherChannels) {
  const Eigen::MatrixXd observed = Eigen::MatrixXd::Random(4, uneven.size());
  const Eigen::MatrixXd history = map_->apply(uneven, inner, observed);
  const std::vector<int> channels = map_->observed_channels(1);
  const Eigen::MatrixXd alone = map_->apply(uneven, inner, observed(channels, Eigen::all));
  EXPECT_EQ(alone, history.row(1));
}

INSTANTIATE_TEST_SUITE_P(All, HistoryMaps, testing::Bool(),
                         [](const auto& is_rate) { return is_rate.param ? "Rate" : "Balance"; });

}  // namespace
}  // namespace pleuel::test::history_map_test
