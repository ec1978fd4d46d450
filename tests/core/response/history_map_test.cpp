#include "core/response/history_map.hpp"

#include <memory>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "core/base/machine_memory.hpp"
#include "core/response/analysis.hpp"
#include "core/response/history_jump.hpp"
#include "core/response/reduction.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::history_map_test {
namespace {

// Linear maps from what is observed to histories.

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

// Peaks beside jumps, and ranges that end with one.

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

constexpr const char* pendulum = R"({"scene": {"gravity": [0, -9.81, 0],
    "materials": {"m": {"young": 210e9, "poisson": 0.3, "density": 7850}},
    "bodies": {"b": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "m",
      "section": {"type": "rectangle", "width": 0.02, "height": 0.02}, "elements": 1000}},
    "joints": {"j": {"type": "revolute", "bodies": ["ground", "b"], "at": [0, 0, 0]}}},
  "simulation": {"end_time": 1, "step": 1e-9},
  "responses": {"s": {"type": "stress", "body": "b", "over_time": "max"}}})";

TEST(Memory, ByDefaultFollowsTheMachineUpToFourGigabytes) {
  EXPECT_GT(machine_memory(), 1e7);
  const double states = problem_from(pendulum).sensitivity.memory;
  EXPECT_LE(states, 4e9);
  EXPECT_LE(states, 0.25 * machine_memory());
  const std::vector<std::string> given = {R"(/sensitivity={"memory": "1 MB"})"};
  EXPECT_EQ(problem_from(pendulum, given).sensitivity.memory, 1e6);
}

/// 1e9 steps with the stress of thousands of places are some 1e13 bytes.
TEST(Memory, OfHistoriesThatNoMachineHoldsIsTooMuchBeforeTheRun) {
  const ProblemFile problem = problem_from(pendulum);
  const std::string said = thrown<InputError>([&] { require_memory(problem); });
  EXPECT_THAT(said, HasSubstr("1e+09 steps with"));
  EXPECT_THAT(said, HasSubstr("but the machine has"));
  EXPECT_THROW(analyze(problem, start_design(problem)), InputError);
}

}  // namespace
}  // namespace pleuel::test::history_map_test
