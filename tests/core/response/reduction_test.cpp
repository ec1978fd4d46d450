#include "core/response/reduction.hpp"

#include <functional>
#include <random>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/analysis.hpp"
#include "core/response/composed_signals.hpp"
#include "core/response/peak_place.hpp"
#include "tests/core/response/response_samples.hpp"
#include "tests/picture/picture_problems.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/test.hpp"

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

/// Four elements of equal lengths: node k is at k/4, wherever frames divide the beam.
TEST(PeakPlace, CountsElementsThroughAllFrames) {
  for (const char* more : {R"("frame": "tangent")", R"("frames": 2)"}) {
    const auto [problem, x, analysis] = AtStart(turning_arm(more));
    const auto share = [&analysis = analysis](const std::string& place) {
      return share_of_place(analysis->model, "arm", place);
    };
    EXPECT_EQ(share("node 0, y = 0.01 m, z = 0.005 m"), 0.0) << more;
    EXPECT_DOUBLE_EQ(*share("node 2.5, y = 0.01 m, z = 0.005 m"), 0.625) << more;
    EXPECT_DOUBLE_EQ(*share("node 4"), 1.0) << more;
    EXPECT_EQ(share("at 0.25 of the length, y"), 0.25) << more;
  }
}

TEST(PeakPlace, IsUnknownOfOtherWordsAndOtherBodies) {
  const auto [problem, x, analysis] = AtStart(turning_arm(R"("frame": "tangent")"));
  EXPECT_EQ(share_of_place(analysis->model, "arm", "drive"), std::nullopt);
  EXPECT_EQ(share_of_place(analysis->model, "arm", "node of"), std::nullopt);
  EXPECT_EQ(share_of_place(analysis->model, "ball", "node 1"), std::nullopt);
}

/// A cantilever that is turned bends most at its root: the peak that the words say.
TEST(PeakPlace, IsWhereTheSignalSaysThatThePeakIs) {
  const auto [problem, x, analysis] = AtStart(turning_arm(R"("frame": "tangent")"));
  const Reduction& bending = analysis->reductions[0];
  const std::string place =
      analysis->responses[0].history()->signal->describe(bending.samples.front().channel);
  EXPECT_EQ(share_of_place(analysis->model, "arm", place), 0.0) << place;
}

/// q₀, −q₀ and 2 q₁ − 1.
class ThreeLines final : public Signal {
 public:
  int channels() const override { return 3; }
  std::string describe(int channel) const override { return fmt::format("line {}", channel); }
  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    values << state.q(0), -state.q(0), 2.0 * state.q(1) - 1.0;
  }
  void add_gradient(const State&, int channel, double weight, SignalGradient& gradient) override {
    if (channel == 2) {
      gradient.q(1) += 2.0 * weight;
    } else {
      gradient.q(0) += channel == 0 ? weight : -weight;
    }
  }
};

/// max(|q₀|, 2 q₁ − 1) and its slope, one after the other of its three sides.
TEST(LargestSignal, IsTheLargestAtEachInstant) {
  LargestSignal signal(std::make_unique<ThreeLines>(), "largest");
  EXPECT_EQ(signal.channels(), 1);
  EXPECT_EQ(signal.describe(0), "largest");
  struct Case {
    Eigen::Vector2d q;
    double value;
    Eigen::Vector2d slope;
  };
  for (const Case& one : {Case{{0.5, 0.0}, 0.5, {1.0, 0.0}}, Case{{-0.7, 0.5}, 0.7, {-1.0, 0.0}},
                          Case{{-0.7, 1.5}, 2.0, {0.0, 2.0}}}) {
    State state;
    state.q = one.q;
    Eigen::VectorXd value(1);
    signal.observe(state, value);
    EXPECT_EQ(value(0), one.value);
    SignalGradient gradient(2, 0, 0);
    signal.add_gradient(state, 0, 3.0, gradient);
    EXPECT_EQ(Eigen::Vector2d(gradient.q), 3.0 * one.slope);
  }
}

using namespace response_samples;

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
  const PointMotionResponse speed{{"mass"}, {1}, TimeDerivative::first};
  problem.responses = {{"speed", speed, OverTime::min, from, to}};
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
  EXPECT_EQ(
      thrown<InputError>([&] { analyze(falling(0.0201, 0.0202), {}); }),
      "/responses/speed is reduced over a window of time with less than two steps; widen it or "
      "shorten the steps");
}

}  // namespace
}  // namespace pleuel::test::reduction_test
