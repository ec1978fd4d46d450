#include <algorithm>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "core/base/time_law.hpp"
#include "tests/support/differences.hpp"

namespace pleuel::test::table_law_test {
namespace {

using Values = std::vector<double>;

struct Shape {
  std::string name;
  TimeLaw<double> (*make)(Values, Values);
  TimeLaw<Dual> (*make_dual)(Values, std::vector<Dual>);
  int continuous_derivatives;
  bool is_monotone;
};

template <class Scalar>
TimeLaw<Scalar> straight(Values knots, std::vector<Scalar> values) {
  return {TimeLaw<Scalar>::Kind::linear, std::move(values), std::move(knots)};
}
template <class Scalar>
TimeLaw<Scalar> resting_cubic(Values knots, std::vector<Scalar> values) {
  return monotone_cubic(std::move(knots), std::move(values));
}
template <class Scalar>
TimeLaw<Scalar> motion_quintic(Values knots, std::vector<Scalar> values) {
  return monotone_quintic(std::move(knots), std::move(values));
}
template <class Scalar>
TimeLaw<Scalar> natural(Values knots, std::vector<Scalar> values) {
  return cubic_spline(std::move(knots), std::move(values), TableEnds::free);
}
template <class Scalar>
TimeLaw<Scalar> clamped(Values knots, std::vector<Scalar> values) {
  return cubic_spline(std::move(knots), std::move(values), TableEnds::resting);
}

const std::vector<Shape> shapes = {
    {"Linear", straight<double>, straight<Dual>, 0, true},
    {"MonotoneCubic", resting_cubic<double>, resting_cubic<Dual>, 1, true},
    {"MonotoneQuintic", motion_quintic<double>, motion_quintic<Dual>, 2, true},
    {"NaturalSpline", natural<double>, natural<Dual>, 2, false},
    {"ClampedSpline", clamped<double>, clamped<Dual>, 2, false}};

struct Table {
  Values times, values;
};

/// A press, a step, a motion from rest to rest, and noise at unequal distances.
std::vector<Table> tables() {
  std::vector<Table> all = {{{0, 0.25, 0.3, 0.35, 0.6}, {0, 0, 2e4, 0, 0}},
                            {{0, 0.1, 0.101, 0.3}, {0, 0, 200, 200}},
                            {{0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6}, {0, 4, 20, 45, 70, 86, 90}},
                            {{-1.0, 2.0}, {3.0, -1.0}}};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 20; ++i) {
    Table table;
    double time = 0.0;
    for (int k = 0; k < 9; ++k) {
      table.times.push_back(time += 0.01 + uniform(random));
      table.values.push_back(2.0 * uniform(random) - 1.0);
    }
    if (i % 2 == 0) std::sort(table.values.begin(), table.values.end());
    all.push_back(table);
  }
  return all;
}

class TableShape : public testing::TestWithParam<Shape> {};

TEST_P(TableShape, GoesThroughItsPointsAndHoldsTheValuesAtItsEnds) {
  for (const Table& table : tables()) {
    const TimeLaw<double> law = GetParam().make(table.times, table.values);
    const double size =
        1e-14 *
        std::max(1.0, std::abs(*std::max_element(table.values.begin(), table.values.end())));
    for (std::size_t i = 0; i < table.times.size(); ++i) {
      EXPECT_NEAR(law.at(table.times[i]).value, table.values[i], size);
    }
    for (const auto& [time, value] : {std::pair{table.times.front() - 0.1, table.values.front()},
                                      {table.times.back() + 0.1, table.values.back()}}) {
      EXPECT_EQ(law.at(time).value, value);
      EXPECT_EQ(law.at(time).rate, 0.0);
      EXPECT_EQ(law.at(time).acceleration, 0.0);
    }
  }
}

TEST_P(TableShape, HasTheDerivativesOfItsValue) {
  for (const Table& table : tables()) {
    const TimeLaw<double> law = GetParam().make(table.times, table.values);
    for (std::size_t i = 0; i + 1 < table.times.size(); ++i) {
      const double width = table.times[i + 1] - table.times[i];
      const double rise = std::abs(table.values[i + 1] - table.values[i]) + 1e-3;
      for (const double share : {0.2, 0.57, 0.9}) {
        const double time = table.times[i] + share * width;
        const auto value = [&](double s) { return law.at(time + s * width).value; };
        const auto rate = [&](double s) { return law.at(time + s * width).rate; };
        const double scale = rise + std::abs(law.at(time).rate) * width;
        EXPECT_NEAR(law.at(time).rate * width, derivative_at_zero(value, 0.05), 1e-2 * scale);
        EXPECT_NEAR(law.at(time).rate * width, derivative_at_zero(value, 0.005), 1e-7 * scale);
        EXPECT_NEAR(law.at(time).acceleration * width, derivative_at_zero(rate, 0.005),
                    1e-6 * (scale / width + std::abs(law.at(time).acceleration * width)));
      }
    }
  }
}

/// Differences across a knot at 1e-7 of the intervals: what is continuous differs by as much.
TEST_P(TableShape, IsAsSmoothAsItSays) {
  for (const Table& table : tables()) {
    const TimeLaw<double> law = GetParam().make(table.times, table.values);
    for (std::size_t i = 1; i + 1 < table.times.size(); ++i) {
      const double width =
          std::min(table.times[i] - table.times[i - 1], table.times[i + 1] - table.times[i]);
      const double size =
          std::abs(table.values[i + 1]) + std::abs(table.values[i]) + std::abs(table.values[i - 1]);
      const TimeValue<double> before = law.at(table.times[i] - 1e-7 * width),
                              after = law.at(table.times[i] + 1e-7 * width);
      EXPECT_NEAR(before.value, after.value, 1e-5 * size);
      if (GetParam().continuous_derivatives < 1) continue;
      EXPECT_NEAR(before.rate * width, after.rate * width, 1e-4 * size);
      if (GetParam().continuous_derivatives < 2) continue;
      EXPECT_NEAR(before.acceleration * width * width, after.acceleration * width * width,
                  1e-3 * size);
    }
  }
}

TEST_P(TableShape, StaysBetweenNeighbouringValuesWhereItIsMonotone) {
  double beyond = 0.0;
  for (const Table& table : tables()) {
    const TimeLaw<double> law = GetParam().make(table.times, table.values);
    for (std::size_t i = 0; i + 1 < table.times.size(); ++i) {
      const auto [low, high] = std::minmax(table.values[i], table.values[i + 1]);
      double previous = law.at(table.times[i]).value;
      for (int k = 1; k < 200; ++k) {
        const double share = k / 200.0;
        const double value =
            law.at(table.times[i] + share * (table.times[i + 1] - table.times[i])).value;
        beyond = std::max({beyond, (low - value) / (std::abs(low) + std::abs(high) + 1.0),
                           (value - high) / (std::abs(low) + std::abs(high) + 1.0)});
        if (GetParam().is_monotone) {
          const double way = table.values[i + 1] >= table.values[i] ? 1.0 : -1.0;
          EXPECT_GE(way * (value - previous), -1e-12 * (std::abs(low) + std::abs(high)));
        }
        previous = value;
      }
    }
  }
  if (GetParam().is_monotone) {
    EXPECT_LE(beyond, 1e-13);
  } else {
    EXPECT_GE(beyond, 0.1);
  }
}

/// In all values, at places in all intervals; away from the kinks where chords change their sign.
TEST_P(TableShape, IsDifferentiatedByItsValues) {
  const Values times = {0.0, 0.1, 0.25, 0.3, 0.6}, values = {0.5, 1.0, 3.0, 2.0, -1.0};
  for (std::size_t j = 0; j < values.size(); ++j) {
    std::vector<Dual> seeded(values.begin(), values.end());
    seeded[j] = Dual(values[j], Dual::Derivatives::Constant(1.0));
    const TimeLaw<Dual> law = GetParam().make_dual(times, seeded);
    for (const double time : {0.03, 0.11, 0.27, 0.5}) {
      const auto of = [&](auto member) {
        return [&, member](double s) {
          Values moved = values;
          moved[j] += s;
          return GetParam().make(times, moved).at(time).*member;
        };
      };
      const TimeValue<Dual> found = law.at(time);
      EXPECT_NEAR(derivative_of(found.value),
                  derivative_at_zero(of(&TimeValue<double>::value), 1e-3), 1e-9);
      EXPECT_NEAR(derivative_of(found.rate), derivative_at_zero(of(&TimeValue<double>::rate), 1e-3),
                  1e-7);
      EXPECT_NEAR(derivative_of(found.acceleration),
                  derivative_at_zero(of(&TimeValue<double>::acceleration), 1e-3), 1e-5);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, TableShape, testing::ValuesIn(shapes),
                         [](const auto& test) { return test.param.name; });

/// y = t²(3 − 2t) has no rate at 0 and at 1; y = 1 + 2t no second derivative anywhere.
TEST(Spline, IsExactForTheCubicThatItsEndsAllow) {
  const Values times = {0.0, 0.2, 0.7, 1.0};
  Values bent, line;
  for (const double t : times) {
    bent.push_back(t * t * (3 - 2 * t));
    line.push_back(1 + 2 * t);
  }
  const TimeLaw<double> from_rest = clamped<double>(times, bent),
                        straight_on = natural(times, line);
  for (const double t : {0.1, 0.4, 0.55, 0.9}) {
    EXPECT_NEAR(from_rest.at(t).value, t * t * (3 - 2 * t), 1e-14);
    EXPECT_NEAR(from_rest.at(t).acceleration, 6 - 12 * t, 1e-12);
    EXPECT_NEAR(straight_on.at(t).value, 1 + 2 * t, 1e-14);
  }
}

TEST(MotionTable, StartsAndEndsAtRest) {
  const Values times = {0.0, 0.1, 0.2}, values = {0.0, 1.0, 3.0};
  for (const auto make : {motion_quintic<double>, clamped<double>}) {
    const TimeLaw<double> law = make(times, values);
    EXPECT_EQ(law.at(0.0).rate, 0.0);
    EXPECT_NEAR(law.at(0.2 * (1 - 1e-12)).rate, 0.0, 1e-8);
  }
}

TEST(StepTable, HoldsEachValueAndTakesTheMeanAtAJumpAndTheNewValueAtTheStart) {
  const TimeLaw<double> law{TimeLaw<double>::Kind::step, {1.0, 4.0, 2.0}, {-1.0, 0.0, 0.5}};
  EXPECT_EQ(law.at(-2.0).value, 1.0);
  EXPECT_EQ(law.at(-0.1).value, 1.0);
  EXPECT_EQ(law.at(-1e-300).value, 1.0);
  EXPECT_EQ(law.at(0.0).value, 4.0);
  EXPECT_EQ(law.at(0.2).value, 4.0);
  EXPECT_EQ(law.at(0.5).value, 3.0);
  EXPECT_EQ(law.at(0.6).value, 2.0);
  EXPECT_EQ(law.at(0.6).rate, 0.0);
}

}  // namespace
}  // namespace pleuel::test::table_law_test
