#include <random>

#include "core/base/stopwatch.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::compared_times_test {
namespace {

/// A machine on which work takes up to 30 % more or less than it should.
class NoisyMachine {
 public:
  explicit NoisyMachine(unsigned seed) : random_(seed) {}

  std::function<void()> work(double seconds) {
    return [this, seconds] { now_ += seconds * (1.0 + 0.3 * noise_(random_)); };
  }
  std::function<double()> clock() const {
    return [this] { return now_; };
  }
  /// Beside a work of 10 ms.
  ComparedTime beside(double seconds, double budget) {
    return compare_times({work(0.01), work(seconds)}, {.seconds = budget, .clock = clock()}).back();
  }

 private:
  std::mt19937 random_;
  std::uniform_real_distribution<double> noise_{-1.0, 1.0};
  double now_ = 0.0;
};

constexpr int trials = 2000;

/// How often works are said to differ, and the wrong one to be slower.
struct Statements {
  int all = 0, wrong = 0;
};

Statements statements_about(double seconds, double budget) {
  Statements said;
  for (int i = 0; i < trials; ++i) {
    NoisyMachine machine(i);
    const ComparedTime time = machine.beside(seconds, budget);
    said.all += time.is_measurable();
    said.wrong += time.is_measurable() && time.change < 0.0;
  }
  return said;
}

/// Seven rounds agree by accident in 2/2⁷ = 1.6 % of all cases, which is 31 of 2000 with a deviation of
/// 5.5; of fifty, level 0.4 %, 8 with a deviation of 3.
TEST(ComparedTimes, OfTheSameWorkDifferByAccidentOnly) {
  EXPECT_LT(statements_about(0.01, 0.0).all, 31 + 17);
  EXPECT_LT(statements_about(0.01, 1.0).all, 8 + 9);
}

TEST(ComparedTimes, NameTheSlowerWorkOrNone) {
  const Statements few = statements_about(0.013, 0.0), many = statements_about(0.013, 2.0);
  EXPECT_EQ(few.wrong, 0);
  EXPECT_EQ(many.wrong, 0);
  EXPECT_GT(many.all, trials * 0.98);
  EXPECT_EQ(statements_about(0.0105, 2.0).wrong, 0);
}

/// 1.3 times as long: the median of the ratio of two numbers within 30 % is their ratio.
TEST(ComparedTimes, AreWithinTheirSpread) {
  int within = 0;
  for (int i = 0; i < trials; ++i) {
    const ComparedTime time = NoisyMachine(i).beside(0.013, 1.0);
    EXPECT_NEAR(time.seconds, 0.013, 0.003);
    within += std::abs(time.change - 0.3) <= time.spread;
  }
  EXPECT_GE(within, trials * 0.99);
}

TEST(ComparedTimes, AreRelativeToTheFirstOfSeveral) {
  NoisyMachine machine(1);
  const auto times = compare_times({machine.work(1.0), machine.work(3.0), machine.work(0.3)},
                                   {.seconds = 0.0, .clock = machine.clock()});
  ASSERT_EQ(times.size(), 3u);
  EXPECT_EQ(times[0].change, 0.0);
  EXPECT_EQ(times[0].spread, 0.0);
  EXPECT_GT(times[1].change, times[1].spread);
  EXPECT_LT(times[2].change, -times[2].spread);
}

/// Works of a minute are done twice, once to warm up, and nothing is said of them.
TEST(ComparedTimes, OfLongWorksAreNotMeasurable) {
  int count = 0;
  double now = 0.0;
  const auto work = [&](double seconds) {
    return [&, seconds] {
      ++count;
      now += seconds;
    };
  };
  const auto times = compare_times({work(60.0), work(90.0)}, {.clock = [&] { return now; }});
  EXPECT_EQ(count, 4);
  EXPECT_DOUBLE_EQ(times[1].change, 0.5);
  EXPECT_FALSE(times[1].is_measurable());
}

}  // namespace
}  // namespace pleuel::test::compared_times_test
