#include <array>
#include <limits>
#include <optional>
#include <random>
#include <variant>

#include "core/base/eager_matrices.hpp"
#include "core/base/number_text.hpp"
#include "core/base/packed.hpp"
#include "core/base/stopwatch.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::texts_test {
namespace {

TEST(NumberText, SharesArePercentsUntilTheyAreHardToRead) {
  EXPECT_EQ(percent(0.4517), "45.2 %");
  EXPECT_EQ(percent(9.99), "999.0 %");
  EXPECT_EQ(percent(2396.99), "2397 times");
  EXPECT_EQ(percent(-12.34), "-12.3 times");
  EXPECT_EQ(percent(3.1e9), "3.10e+09 times");
}

TEST(NumberText, WhatIsRoundedToNothingHasNoSign) {
  EXPECT_EQ(percent(-1e-9), "0.0 %");
  EXPECT_EQ(signed_percent(-4e-4), "0.0 %");
  EXPECT_EQ(signed_percent(0.0), "0.0 %");
  EXPECT_EQ(signed_percent(6e-4), "+0.1 %");
  EXPECT_EQ(signed_percent(-0.021), "−2.1 %");
}

TEST(NumberText, NumbersKeepTheirSignificantDigits) {
  EXPECT_EQ(significant(25.13), "25.130");
  EXPECT_EQ(significant(0.2), "0.20000");
  EXPECT_EQ(significant(1.2e-7, 2), "1.2e-07");
  EXPECT_EQ(significant(0.0), "0");
}

TEST(NumberText, HasItsSignWhereThatIsAsked) {
  EXPECT_EQ(signed_significant(25.13), "+25.130");
  EXPECT_EQ(signed_significant(-0.2, 2), "−0.20");
  EXPECT_EQ(signed_significant(0.0), "0");
}

TEST(NumberText, OfRoughPercentsHasTwoDigits) {
  EXPECT_EQ(rough_percent(0.000311), "0.031 %");
  EXPECT_EQ(rough_percent(0.05), "5 %");
  EXPECT_EQ(rough_percent(0.996), "100 %");
  EXPECT_EQ(rough_percent(2.347), "235 %");
}

TEST(NumberText, OfRatiosSaysWhereTheyTellNothing) {
  EXPECT_EQ(times_as_large(1.9666), "1.97 times as large");
  EXPECT_EQ(times_as_large(0.5), "0.5 times as large");
  EXPECT_EQ(times_as_large(1e4), "larger by far");
  EXPECT_EQ(times_as_large(1.0 / 0.0), "larger by far");
  EXPECT_EQ(times_as_large(-3.0), "of the other sign");
}

enum class Colour { red, green };

struct Thing {
  std::string name;
  std::vector<std::optional<double>> numbers;
  Eigen::VectorXd vector;
  Eigen::MatrixXd matrix;
  std::map<std::pair<std::string, int>, Colour> colours;
  bool is_new = false;

  bool operator==(const Thing&) const = default;
};

TEST(Packed, ValuesComeBackBitByBit) {
  const Thing thing{"a\0b\n",
                    {0.1, std::nullopt, -0.0, 5e-324},
                    Eigen::Vector3d(1.0 / 3.0, std::numeric_limits<double>::infinity(), 1e308),
                    Eigen::MatrixXd::Random(2, 5),
                    {{{"rod", 3}, Colour::green}, {{"", 0}, Colour::red}},
                    true};
  const Thing same = unpacked<Thing>(packed(thing));
  EXPECT_EQ(same, thing);
  EXPECT_TRUE(std::signbit(*same.numbers[2]));
}

TEST(Packed, EmptyMatricesKeepTheirShape) {
  const Eigen::MatrixXd wide(0, 4);
  const auto same = unpacked<Eigen::MatrixXd>(packed(wide));
  EXPECT_EQ(same.rows(), 0);
  EXPECT_EQ(same.cols(), 4);
}

TEST(Packed, SizesBeyondTheBytesTakeNoMemory) {
  const std::uint64_t huge = std::uint64_t{1} << 60;
  const std::string size(reinterpret_cast<const char*>(&huge), sizeof huge);
  EXPECT_THROW(unpacked<std::string>(size), std::runtime_error);
  EXPECT_THROW(unpacked<Eigen::MatrixXd>(size + size), std::runtime_error);
  EXPECT_THROW(unpacked<Eigen::MatrixXd>(packed(std::uint64_t{1}) + size), std::runtime_error);
  EXPECT_THROW(unpacked<std::vector<double>>(size), std::runtime_error);
}

TEST(Packed, BytesThatEndTooEarlyAreAnError) {
  const std::string bytes = packed(std::string("words"), 1.0);
  std::string text;
  double number = 0.0;
  EXPECT_THROW(unpack(bytes.substr(0, bytes.size() - 1), text, number), std::runtime_error);
}

struct One {
  double number;
};
struct Mixed {
  std::string text = {};
  std::array<double, 3> place = {};
  std::vector<One> ones = {};
  std::variant<int, std::string> either = {};
  std::optional<One> perhaps = {};
  const char* last = "last";
};
struct Largest {
  int a1, a2, a3, a4, a5, a6, a7, a8, a9, a10, a11, a12, a13;
  int b1, b2, b3, b4, b5, b6, b7, b8, b9, b10, b11, b12, b13;
};

TEST(Members, AreCounted) {
  EXPECT_EQ(member_count<One>, 1u);
  EXPECT_EQ(member_count<Mixed>, 6u);
  EXPECT_EQ(member_count<Largest>, most_members);
}

TEST(Members, ComeInTheirOrder) {
  Largest largest{};
  int next = 0;
  with_members(largest, [&](auto&... members) { ((members = ++next), ...); });
  EXPECT_EQ(next, 26);
  EXPECT_EQ(largest.a1, 1);
  EXPECT_EQ(largest.a13, 13);
  EXPECT_EQ(largest.b13, 26);
}

TEST(Members, OfAConstantStructAreConstant) {
  const Mixed mixed{};
  const bool are_constant = with_members(
      mixed, []<class... Members>(Members&...) { return (std::is_const_v<Members> && ...); });
  EXPECT_TRUE(are_constant);
}

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
}  // namespace pleuel::test::texts_test
