#include <array>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/scene/problem_reader.hpp"
#include "studies/pareto.hpp"

/// Fronts between two responses.
namespace pleuel::test {
namespace {

/// A square bar of 1 m and side a: its mass is ρ a². The response "slack" is (60 mm/a)² · 1 kg + k·b, with
/// a variable b that nothing else depends on.
ProblemFile bar(const std::string& responses, int points, const std::string& more = "") {
  return read_problem_text(
      R"({"scene": {"bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0],
    "rigid": true, "material": "steel", "elements": 1,
    "section": {"type": "rectangle", "width": {"variable": "side"}, "height": {"variable": "side"}}}},
    "joints": {"wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}}},
  "simulation": {"end_time": "2 ms", "step": "1 ms", "resolution_check": false},
  "variables": {"side": {"start": "40 mm", "lower": "20 mm", "upper": "60 mm"},
                "extra": {"start": "0.7 m", "lower": "0.2 m", "upper": "1 m"}},
  "responses": {"mass": {"type": "mass"},
    "slack": {"type": "expression", "value": "(1 kg) * ((60 mm) / (side))^2 + (1 kg/m) * extra"},
    "goodness": {"type": "expression", "value": "0 - slack"}},)" +
          more + R"("pareto": {"responses": [)" + responses + R"(], "points": )" +
          std::to_string(points) + "}}",
      "bar.json");
}

constexpr double density = 7850.0;
double mass(double a) {
  return density * a * a;
}
double slack(double a, double b) {
  return 0.06 * 0.06 / (a * a) + b;
}

std::vector<ParetoPoint> front(const ProblemFile& file, int jobs = 1) {
  return pareto_front(trade_off_problem(file), {}, {{.jobs = jobs}, nullptr});
}

TEST(TradeOff, GoesFromTheBestForOneToTheBestForTheOther) {
  const auto points = front(bar(R"("mass", "slack")", 5));
  ASSERT_EQ(points.size(), 5u);
  const double largest = slack(0.02, 0.2), smallest = slack(0.06, 0.2);
  for (std::size_t i = 0; i < 5; ++i) {
    const ParetoPoint& point = points[i];
    const double limit = std::lerp(largest, smallest, static_cast<double>(i) / 4.0);
    const double a = 0.06 / std::sqrt(limit - 0.2);
    EXPECT_EQ(point.result.status, Status::verified) << point.result.message;
    // An end may miss its goal by 1e-4 of its value; of the mass that is 1e-4 of slack − 0.2 ~ 1/mass,
    // though the front is eight times as long as the lightest mass.
    EXPECT_NEAR(point.limited_value, limit, 1.5e-4 * largest) << i;
    EXPECT_NEAR(point.result.evaluation.objective, mass(a), 2e-4 * mass(a)) << i;
    EXPECT_FALSE(point.is_dominated);
    EXPECT_EQ(point.is_end, i == 0 || i == 4);
  }
}

TEST(TradeOff, TakesOfEquallyGoodEndsTheBetterForTheOther) {
  // The mass does not depend on b; the lightest bar with b = 0.7 m would be dominated.
  const auto points = front(bar(R"("mass", "slack")", 2));
  ASSERT_EQ(points.size(), 2u);
  EXPECT_NEAR(points[0].result.x(1), 0.2, 1e-6);
}

TEST(TradeOff, MaximizesAsItMinimizesTheNegative) {
  const auto low = front(bar(R"("mass", "slack")", 4));
  const auto high = front(bar(R"({"minimize": "mass"}, {"maximize": "goodness"})", 4));
  ASSERT_EQ(low.size(), high.size());
  for (std::size_t i = 0; i < low.size(); ++i) {
    EXPECT_NEAR(high[i].limited_value, -low[i].limited_value, 1e-6);
    EXPECT_NEAR(high[i].result.x(0), low[i].result.x(0), 1e-6);
  }
}

TEST(TradeOff, MayBeTurnedAround) {
  const auto points = front(bar(R"({"maximize": "goodness"}, "mass")", 3));
  ASSERT_EQ(points.size(), 3u);
  const double middle = 0.5 * (mass(0.02) + mass(0.06));
  EXPECT_NEAR(points[1].limited_value, middle, 1e-4 * middle);
  // What is maximized is minimized with a minus.
  EXPECT_NEAR(points[1].result.evaluation.objective, slack(std::sqrt(middle / density), 0.2), 1e-3);
}

TEST(TradeOff, IsOnePointWhereNothingIsToBeTraded) {
  const auto points = front(bar(R"("slack", {"maximize": "goodness"})", 5));
  ASSERT_EQ(points.size(), 1u);
  EXPECT_NEAR(points[0].limited_value, -slack(0.06, 0.2), 1e-6);
}

TEST(TradeOff, KeepsTheLimitsOfTheFile) {
  const auto points =
      front(bar(R"("mass", "slack")", 3,
                R"("constraints": {"slack": {"response": "slack", "upper": "3 kg"}},)"));
  ASSERT_EQ(points.size(), 3u);
  EXPECT_NEAR(points[0].limited_value, 3.0, 1e-3);
}

TEST(TradeOff, IsTheSameForAnyNumberOfJobs) {
  const ProblemFile file = bar(R"("mass", "slack")", 5);
  const auto one = front(file, 1), two = front(file, 2);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i].result.x, two[i].result.x);
}

TEST(TradeOff, IsBetweenTwoResponses) {
  EXPECT_THROW(bar(R"("mass", "mass")", 3), InputError);
  EXPECT_THROW(bar(R"("mass")", 3), InputError);
  EXPECT_THROW(bar(R"("mass", "sack")", 3), InputError);
  EXPECT_THROW(bar(R"("mass", {"minimize": "slack", "maximize": "slack"})", 3), InputError);
}

}  // namespace
}  // namespace pleuel::test
