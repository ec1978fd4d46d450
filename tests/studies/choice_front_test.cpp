#include <array>
#include <limits>

#include "core/base/error.hpp"
#include "studies/pareto.hpp"
#include "studies/pareto_point.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

/// Fronts of sizes from lists.

/// Fronts between two responses.

namespace pleuel::test::choice_front_test {
namespace {

constexpr double density = 7850.0;
const std::vector<double> widths = {0.02, 0.03, 0.045}, heights = {0.025, 0.04, 0.05, 0.06};

std::string mm_list(const std::vector<double>& sizes) {
  std::vector<std::string> texts;
  for (const double size : sizes) texts.push_back(fmt::format("\"{} mm\"", 1e3 * size));
  return fmt::format("{}", fmt::join(texts, ", "));
}

constexpr const char* fixed = R"({"start": "0.5 m", "lower": "0.5 m", "upper": "0.5 m"})";
constexpr const char* designed = R"({"start": "0.7 m", "lower": "0.5 m", "upper": "1 m"})";
constexpr const char* both = R"({"responses": ["mass", "slack"]})";
constexpr const char* both_at_three = R"({"responses": ["mass", "slack"], "points": 3})";

/// A rigid bar of 1 m at the wall, of steel; its sides are variables.
std::string bar_text(const std::string& variables, const std::string& width,
                     const std::string& height, const std::string& responses,
                     const std::string& pareto, const std::string& more = "") {
  return fmt::format(
      R"({{"scene": {{"bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0],
    "rigid": true, "material": "steel", "elements": 1, "section": {{"type": "rectangle",
    "width": {{"variable": "{}"}}, "height": {{"variable": "{}"}}}}}}}},
    "joints": {{"wall": {{"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}}}}}},
  "simulation": {{"end_time": "2 ms", "step": "1 ms", "resolution_check": false}},
  "variables": {}, "responses": {}, {} "pareto": {}}})",
      width, height, variables, responses, more, pareto);
}

/// Width b and height h are from lists: the mass is ρ b h. The response "slack" is 1/(b h²) with
/// 10⁻⁵ m³, and a tenth of a length that may be designed, too.
ProblemFile bar(const std::string& pareto, const std::string& extra = fixed,
                const std::string& more = "") {
  const std::string variables =
      fmt::format(R"({{"b": {{"choices": [{}]}}, "h": {{"choices": [{}]}}, "extra": {}}})",
                  mm_list(widths), mm_list(heights), extra);
  return problem_from(bar_text(variables, "b", "h", R"({"mass": {"type": "mass"},
    "slack": {"type": "expression", "value": "extra/(10 m) + 1e-5*(1 m)/b*((1 m)/h)^2"},
    "goodness": {"type": "expression", "value": "0 - slack"}})",
                               pareto, more));
}

double slack(double b, double h) {
  return 1e-5 / (b * h * h) + 0.05;
}

struct Bar {
  double b, h;
};

/// By going through all of them: those for which no other is as light and as stiff.
std::vector<Bar> best_bars() {
  std::vector<Bar> best;
  for (const double b : widths) {
    for (const double h : heights) {
      bool is_dominated = false;
      for (const double c : widths) {
        for (const double k : heights) {
          const double mass = c * k - b * h, loose = slack(c, k) - slack(b, h);
          is_dominated = is_dominated || (mass <= 1e-12 && loose <= 1e-12 && mass + loose < -1e-9);
        }
      }
      if (!is_dominated) best.push_back({b, h});
    }
  }
  std::sort(best.begin(), best.end(), [](const Bar& one, const Bar& other) {
    return slack(one.b, one.h) < slack(other.b, other.h);
  });
  return best;
}

ParetoFront front_of(const ProblemFile& file, int jobs = 1) {
  return pareto_front(trade_off_problem(file), {}, {{.jobs = jobs}, nullptr});
}

void expect_bars(const std::vector<ParetoPoint>& points, const std::vector<Bar>& bars) {
  ASSERT_EQ(points.size(), bars.size());
  for (std::size_t i = 0; i < bars.size(); ++i) {
    EXPECT_EQ(points[i].result.status, Status::verified) << points[i].result.message;
    EXPECT_DOUBLE_EQ(points[i].result.x(0), bars[i].b) << i;
    EXPECT_DOUBLE_EQ(points[i].result.x(1), bars[i].h) << i;
    EXPECT_NEAR(points[i].limited_value, slack(bars[i].b, bars[i].h), 1e-9);
    EXPECT_NEAR(points[i].result.evaluation.objective, density * bars[i].b * bars[i].h, 1e-9);
    EXPECT_FALSE(points[i].has_multiplier());
    EXPECT_FALSE(points[i].is_dominated);
  }
}

/// The same digits.
void expect_same_designs(const std::vector<ParetoPoint>& one,
                         const std::vector<ParetoPoint>& other) {
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].result.x, other[i].result.x) << i;
    EXPECT_EQ(std::abs(one[i].limited_value), std::abs(other[i].limited_value)) << i;
  }
}

TEST(ChoiceFront, IsThatOfAllChoices) {
  const std::vector<Bar> best = best_bars();
  ASSERT_GT(best.size(), 3u);
  ASSERT_LT(best.size(), widths.size() * heights.size()) << "none is dominated: it says little";
  const ParetoFront front = front_of(bar(both));
  expect_bars(front.points, best);
  ASSERT_TRUE(front.choices);
  EXPECT_EQ(front.choices->all, 12);
  EXPECT_EQ(front.choices->feasible, 12);
  EXPECT_EQ(front.choices->failed, 0);
  EXPECT_TRUE(front.is_whole);
}

TEST(ChoiceFront, OfWhatIsMaximizedIsThatOfTheNegative) {
  const auto high = front_of(bar(R"({"responses": ["mass", {"maximize": "goodness"}]})")).points;
  expect_same_designs(high, front_of(bar(both)).points);
}

TEST(ChoiceFront, IsTheSameForAnyNumberOfJobs) {
  expect_same_designs(front_of(bar(both), 3).points, front_of(bar(both), 1).points);
}

constexpr const char* slack_limit =
    R"("objective": {"minimize": "mass"}, "constraints": {"loose": {"response": "slack", "upper": 0.4}},)";

/// The best for the tight end is the loosest within it, and the front ends at the loose end.
TEST(ChoiceFront, OverALimitIsWhatIsBestBetweenItsEnds) {
  const std::vector<Bar> best = best_bars();
  const double tight = 0.5 * (slack(best[1].b, best[1].h) + slack(best[2].b, best[2].h));
  const double loose = slack(best[4].b, best[4].h) * 1.001;
  for (const bool is_turned : {false, true}) {
    const std::string range = fmt::format(R"({{"constraint": "loose", "from": {}, "to": {}}})",
                                          is_turned ? loose : tight, is_turned ? tight : loose);
    expect_bars(front_of(bar(range, fixed, slack_limit)).points,
                {best[1], best[2], best[3], best[4]});
  }
}

TEST(ChoiceFront, KeepsTheOtherLimits) {
  const std::vector<Bar> best = best_bars();
  const auto front_below = [](double most) {
    return front_of(bar(
        both, fixed,
        fmt::format(R"("constraints": {{"own": {{"response": "slack", "upper": {}}}}},)", most)));
  };
  expect_bars(front_below(slack(best[2].b, best[2].h) * 1.001).points, {best[0], best[1], best[2]});
  const ParetoFront none = front_below(0.01);
  EXPECT_TRUE(none.points.empty());
  EXPECT_EQ(none.choices->feasible, 0);
}

/// Bars of 32 mm to 38 mm have no value of the square root.
TEST(ChoiceFront, LeavesOutWhatCannotBeSimulated) {
  const auto front_with = [](const std::string& sizes) {
    return front_of(
        problem_from(bar_text(R"({"a": {"choices": [)" + sizes + "]}}", "a", "a", R"json(
      {"mass": {"type": "mass"}, "slack": {"type": "expression",
       "value": "((60 mm)/a)^2 + 0*sqrt((a/(1 mm) - 35)^2 - 9)"}})json",
                              both)));
  };
  const ParetoFront front = front_with(R"("30 mm", "34 mm", "35 mm", "40 mm")");
  EXPECT_EQ(front.choices->failed, 2);
  ASSERT_EQ(front.points.size(), 2u);
  EXPECT_DOUBLE_EQ(front.points[0].result.x(0), 0.04);
  EXPECT_DOUBLE_EQ(front.points[1].result.x(0), 0.03);
  const ParetoFront none = front_with(R"("34 mm", "35 mm")");
  EXPECT_EQ(none.choices->failed, 2);
  EXPECT_TRUE(none.points.empty());
}

/// With another variable every point is a search: the best bar for each limit, with the least
/// extra.
TEST(ChoiceFront, WithOtherVariablesChoosesAtEachLimit) {
  const ParetoFront front =
      front_of(bar(R"({"constraint": "loose", "from": 0.15, "to": 0.45, "points": 4})", designed,
                   slack_limit),
               2);
  EXPECT_FALSE(front.choices);
  ASSERT_EQ(front.points.size(), 4u);
  for (const ParetoPoint& point : front.points) {
    EXPECT_EQ(point.result.status, Status::verified) << point.result.message;
    double lightest = std::numeric_limits<double>::infinity();
    for (const double b : widths) {
      for (const double h : heights) {
        if (slack(b, h) <= point.limit) lightest = std::min(lightest, density * b * h);
      }
    }
    EXPECT_NEAR(point.result.evaluation.objective, lightest, 1e-6) << point.limit;
    EXPECT_FALSE(point.has_multiplier());
  }
}

TEST(ChoiceFront, BetweenResponsesWithOtherVariablesGoesFromBestToBest) {
  const ParetoFront front = front_of(bar(both_at_three, designed));
  ASSERT_EQ(front.points.size(), 3u);
  EXPECT_NEAR(front.points.front().result.evaluation.objective, density * 0.02 * 0.025, 1e-6);
  EXPECT_NEAR(front.points.back().limited_value, slack(0.045, 0.06), 1e-4);
}

/// 12 choices are all tried beside another variable; of 18 · 18, more than can be simulated, some are.
TEST(ChoiceFront, SaysWhetherAllChoicesWereTriedForAPoint) {
  const ParetoFront few = front_of(bar(both_at_three, designed));
  for (const ParetoPoint& point : few.points) {
    ASSERT_TRUE(point.sizes);
    EXPECT_TRUE(point.sizes->is_exhaustive);
    EXPECT_EQ(point.sizes->tried, 12);
  }
  ProblemFile many = bar(both_at_three);
  for (std::size_t i = 0; i < 2; ++i) {
    std::vector<SizeChoice>& choices = many.variables[i].choices;
    const SizeChoice last = choices.back();
    while (choices.size() < 18) {
      choices.push_back(last);
      choices.back().value = last.value * (1.0 + 0.05 * static_cast<double>(choices.size()));
    }
    many.variables[i].upper = choices.back().value;
  }
  for (const ParetoPoint& point : front_of(many).points) {
    ASSERT_TRUE(point.sizes);
    EXPECT_EQ(point.sizes->combinations, 324.0);
    EXPECT_FALSE(point.sizes->is_exhaustive);
    EXPECT_LT(point.sizes->tried, 324);
  }
}

TEST(ChoiceFront, TakesNoGapWhereNotAllChoicesAreSimulated) {
  const ProblemFile file = bar(R"({"responses": ["mass", "slack"], "gap": 0.1})", designed);
  EXPECT_THAT(thrown<InputError>([&] { front_of(file); }), HasSubstr("/pareto/gap"))
      << "no complaint";
}

TEST(NonDominated, KeepsEqualOnesAndDropsTheWorse) {
  EXPECT_THAT(non_dominated({{1.0, 2.0}, {2.0, 1.0}, {2.0, 2.0}, {1.0, 2.0}, {1.0, 2.1}}),
              ElementsAre(true, true, false, true, false));
  // Half of round-off is no difference; ten times as much is one.
  EXPECT_THAT(non_dominated({{1.0, 2.0}, {1.0 + 5e-10, 2.0}}), ElementsAre(true, true));
  EXPECT_THAT(non_dominated({{1.0, 2.0}, {1.0 + 1e-8, 2.0}}), ElementsAre(true, false));
  EXPECT_TRUE(non_dominated({}).empty());
}

/// A square bar of 1 m and side a: its mass is ρ a². The response "slack" is (60 mm/a)² · 1 kg +
/// k·b, with a variable b that nothing else depends on.
ProblemFile square_bar(const std::string& responses, int points, const std::string& more = "",
                       const std::string& others = R"({"mass": {"type": "mass"},
    "slack": {"type": "expression", "value": "(1 kg) * ((60 mm) / (side))^2 + (1 kg/m) * extra"},
    "goodness": {"type": "expression", "value": "0 - slack"}})") {
  const std::string pareto =
      R"({"responses": [)" + responses + R"(], "points": )" + std::to_string(points) + "}";
  return problem_from(bar_text(R"({"side": {"start": "40 mm", "lower": "20 mm", "upper": "60 mm"},
                                   "extra": {"start": "0.7 m", "lower": "0.2 m", "upper": "1 m"}})",
                               "side", "side", others, pareto, more));
}

ProblemFile with_gap(ProblemFile file, double gap) {
  file.pareto->gap = gap;
  return file;
}

double mass(double a) {
  return density * a * a;
}
double slack_of(double a, double b) {
  return 0.06 * 0.06 / (a * a) + b;
}

std::vector<ParetoPoint> front(const ProblemFile& file, int jobs = 1) {
  return front_of(file, jobs).points;
}

TEST(TradeOff, GoesFromTheBestForOneToTheBestForTheOther) {
  const auto points = front(square_bar(R"("mass", "slack")", 5));
  ASSERT_EQ(points.size(), 5u);
  const double largest = slack_of(0.02, 0.2), smallest = slack_of(0.06, 0.2);
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
  const auto points = front(square_bar(R"("mass", "slack")", 2));
  ASSERT_EQ(points.size(), 2u);
  EXPECT_NEAR(points[0].result.x(1), 0.2, 1e-6);
}

TEST(TradeOff, MaximizesAsItMinimizesTheNegative) {
  const auto low = front(square_bar(R"("mass", "slack")", 4));
  const auto high = front(square_bar(R"({"minimize": "mass"}, {"maximize": "goodness"})", 4));
  ASSERT_EQ(low.size(), high.size());
  for (std::size_t i = 0; i < low.size(); ++i) {
    EXPECT_NEAR(high[i].limited_value, -low[i].limited_value, 1e-6);
    EXPECT_NEAR(high[i].result.x(0), low[i].result.x(0), 1e-6);
  }
}

TEST(TradeOff, MayBeTurnedAround) {
  const auto points = front(square_bar(R"({"maximize": "goodness"}, "mass")", 3));
  ASSERT_EQ(points.size(), 3u);
  const double middle = 0.5 * (mass(0.02) + mass(0.06));
  EXPECT_NEAR(points[1].limited_value, middle, 1e-4 * middle);
  // What is maximized is minimized with a minus.
  EXPECT_NEAR(points[1].result.evaluation.objective, slack_of(std::sqrt(middle / density), 0.2),
              1e-3);
}

TEST(TradeOff, IsOnePointWhereNothingIsToBeTraded) {
  const ProblemFile file = square_bar(R"("slack", {"maximize": "goodness"})", 5);
  const auto points = front(file);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_NEAR(points[0].limited_value, -slack_of(0.06, 0.2), 1e-6);
  EXPECT_EQ(front(with_gap(file, 0.05)).size(), 1u);
}

TEST(TradeOff, KeepsTheLimitsOfTheFile) {
  const auto points =
      front(square_bar(R"("mass", "slack")", 3,
                       R"("constraints": {"slack": {"response": "slack", "upper": "3 kg"}},)"));
  ASSERT_EQ(points.size(), 3u);
  EXPECT_NEAR(points[0].limited_value, 3.0, 1e-3);
}

/// Distance of neighbours on the front, both goals over their ranges.
double largest_distance(const std::vector<ParetoPoint>& points) {
  const auto objective = [&](std::size_t i) { return points[i].result.evaluation.objective; };
  const std::size_t last = points.size() - 1;
  const double width = points[last].limited_value - points[0].limited_value;
  const double height = objective(last) - objective(0);
  double largest = 0.0;
  for (std::size_t i = 1; i <= last; ++i) {
    largest = std::max(largest,
                       std::hypot((points[i].limited_value - points[i - 1].limited_value) / width,
                                  (objective(i) - objective(i - 1)) / height));
  }
  return largest;
}

TEST(TradeOff, HasNoGapsLargerThanAsked) {
  const ParetoFront found = front_of(with_gap(square_bar(R"("mass", "slack")", 3), 0.1));
  EXPECT_LE(largest_distance(found.points), 0.1);
  EXPECT_NEAR(found.gaps.largest.value(), largest_distance(found.points), 1e-6);
  EXPECT_TRUE(found.gaps.gaps.empty());
  // (slack − 0.2)·mass is constant; its length is below 2, and so at most 2·20 points are needed.
  EXPECT_LE(found.points.size(), 30u);
  for (const ParetoPoint& point : found.points) {
    EXPECT_EQ(point.result.status, Status::verified) << point.result.message;
    const double mass_there = density * 0.06 * 0.06 / (point.limited_value - 0.2);
    EXPECT_NEAR(point.result.evaluation.objective, mass_there, 3e-4 * mass_there);
  }
}

TEST(TradeOff, IsTheSameForAnyNumberOfJobsAlsoInGaps) {
  const ProblemFile plain = square_bar(R"("mass", "slack")", 5),
                    with_gaps = with_gap(square_bar(R"("mass", "slack")", 3), 0.15);
  expect_same_designs(front(plain, 1), front(plain, 2));
  expect_same_designs(front(with_gaps, 1), front(with_gaps, 3));
}

TEST(TradeOff, StopsAtTheMostPoints) {
  ProblemFile file = with_gap(square_bar(R"("mass", "slack")", 3), 0.02);
  file.pareto->most_points = 6;
  const ParetoFront found = front_of(file);
  EXPECT_EQ(found.points.size(), 6u);
  ASSERT_FALSE(found.gaps.gaps.empty());
  EXPECT_EQ(found.gaps.gaps.front().cause, FrontGap::Cause::open);
}

/// The thinnest bar whose wave is not above a value, by going through all of them in steps of 10⁻⁷
/// m.
double thinnest_below(double value) {
  double side = 0.02;
  while (side < 0.06 &&
         1.2 - side / 0.06 + 0.25 * std::sin(3.6 * (side / 0.02 - 1.0) + 2.0) > value) {
    side += 1e-7;
  }
  return side;
}

/// With s = side/20 mm − 1 the wave is 2/3 − s/3 + sin(3.6 s + 2)/4, and 0.2 of the extra. Without
/// that it falls to 0.148 at s = 0.858, rises to 0.392, and is below 0.148 again from s = 1.92 on:
/// bars in between are dominated. The searches from the other end stay on them: local optima.
TEST(TradeOff, JumpsWhereAllThatIsBetweenIsDominated) {
  const std::string wave =
      R"json({"mass": {"type": "mass"}, "wave": {"type": "expression",
             "value": "extra/(1 m) + 1 - side/(60 mm) + 0.25*sin((1 rad)*(3.6*(side/(20 mm) - 1) + 2))"}})json";
  ProblemFile file = with_gap(square_bar(R"("mass", "wave")", 5, "", wave), 0.05);
  file.variables[0].start = 0.058;  // beyond the crest: the best end is found from there
  const ParetoFront found = front_of(file);
  ASSERT_EQ(found.gaps.gaps.size(), 1u);
  const FrontGap& gap = found.gaps.gaps.front();
  EXPECT_EQ(gap.cause, FrontGap::Cause::jump);
  // Between there, nearer than a quarter of 0.05 of the range of 0.84, is 0.2 + 0.148.
  EXPECT_NEAR(found.points[gap.tight].limited_value, 0.348, 0.0105);
  EXPECT_NEAR(found.points[gap.loose].limited_value, 0.348, 0.0105);
  for (const ParetoPoint& point : found.points) {
    EXPECT_EQ(point.result.status, Status::verified) << point.result.message;
    if (point.is_dominated) continue;
    // Steps of 1e-7 m miss the trough of the wave, whose curvature is 8100/m², by 1e-11.
    const double side = thinnest_below(point.limited_value + 2e-11);
    EXPECT_NEAR(point.result.x(0), side, 1e-3 * side) << point.limited_value;
  }
}

/// Two formulas of x and y, from −2 to 2, beside a mechanism that plays no part.
ProblemFile formulas(const std::string& first, const std::string& second,
                     const std::string& more = "", double gap = 0.2) {
  const ProblemFile file = problem_from(
      R"({"scene": {"bodies": {"m": {"type": "point-mass", "at": [0, 0, 0], "mass": "1 kg"}},
    "joints": {}, "gravity": [0, 0, 0], "loads": {"f": {"type": "force", "body": "m",
    "at": [0, 0, 0], "direction": [1, 0, 0], "value": "1 N"}}},
  "simulation": {"end_time": 0.01, "step": 0.005},
  "variables": {"x": {"start": 0.5, "lower": -2, "upper": 2}, "y": {"start": 0.5, "lower": -2, "upper": 2}},
  "responses": {"f": {"type": "expression", "value": ")" +
      first + R"("}, "g": {"type": "expression", "value": ")" + second + R"("}},)" + more +
      R"("pareto": {"responses": ["f", "g"], "points": 3}})");
  return with_gap(file, gap);
}

/// f = x² + y² and g = (x − 1)² + y² trade along √f + √g = 1, with constants that are added to them.
ParetoFront shifted_front(double first, double second) {
  return front_of(
      formulas(fmt::format("{} + x^2 + y^2", first), fmt::format("{} + (x - 1)^2 + y^2", second)));
}

TEST(TradeOff, DoesNotDependOnHowLargeResponsesAreBesideTheirRange) {
  for (const auto& [first, second] : std::vector<std::pair<double, double>>{
           {0.0, 0.0}, {100.0, 0.0}, {100.0, 100.0}, {0.0, 1000.0}}) {
    SCOPED_TRACE(fmt::format("{} {}", first, second));
    const ParetoFront found = shifted_front(first, second);
    EXPECT_GE(found.points.size(), 7u);
    EXPECT_LE(found.points.size(), 25u);
    EXPECT_TRUE(found.gaps.gaps.empty());
    double low = 1.0, high = 0.0;
    for (const ParetoPoint& point : found.points) {
      EXPECT_EQ(point.result.status, Status::verified) << point.result.message;
      EXPECT_FALSE(point.is_dominated) << point.limit;
      const double f = point.result.evaluation.objective - first;
      const double g = point.limited_value - second;
      // 1e-6 of 1000.
      EXPECT_NEAR(std::sqrt(std::max(f, 0.0)) + std::sqrt(std::max(g, 0.0)), 1.0, 1e-3);
      low = std::min(low, f);
      high = std::max(high, f);
    }
    // Each end may miss its best by 1e-4 of the range, which is 0.02 of the other one.
    EXPECT_NEAR(low, 0.0, 1e-3);
    EXPECT_NEAR(high, 1.0, 0.025);
  }
}

/// Searches resolve such goals hardly, to 10⁻⁶ of the value, and not all points are proven; but one
/// point it is not, and none is called worse than another.
TEST(TradeOff, IsNoPointWhereTheRangeIsSmallBesideTheValue) {
  for (const auto& [first, second] :
       std::vector<std::pair<double, double>>{{1000.0, 0.0}, {0.0, 100000.0}}) {
    const ParetoFront found = shifted_front(first, second);
    EXPECT_GE(found.points.size(), 7u);
    double high = 0.0;
    for (const ParetoPoint& point : found.points) {
      EXPECT_FALSE(point.is_dominated) << first << ' ' << second << ": " << point.limit;
      high = std::max(high, point.result.evaluation.objective - first);
    }
    EXPECT_NEAR(high, 1.0, 0.025);
  }
}

/// g = exp(−20 x): f = (ln g / 20)². Seven tenths of f lie in 1e-4 of the range of g.
TEST(TradeOff, HasNoJumpWhereOneGoalCoversDecades) {
  const ParetoFront found = front_of(formulas("x^2 + y^2", "exp(-20*x) + y^2", "", 0.25));
  EXPECT_TRUE(found.gaps.gaps.empty());
  ASSERT_TRUE(found.gaps.largest);
  EXPECT_LE(*found.gaps.largest, 0.25);
  bool has_middle = false;
  for (const ParetoPoint& point : found.points) {
    EXPECT_FALSE(point.is_dominated);
    const double f = std::pow(std::log(point.limited_value) / 20.0, 2);
    EXPECT_NEAR(point.result.evaluation.objective, f, 1e-5);
    has_middle = has_middle || (f > 0.3 && f < 0.7);
  }
  EXPECT_TRUE(has_middle);
}

/// One design is best for both, or the second response is 0 at both ends.
TEST(TradeOff, IsOneVerifiedPointWhereOneDesignIsBestForBoth) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"x^2 + y^2", "3*(x^2 + y^2) + 7"},
      {"(x - 0.3)^2 + y^2", "(x - 0.3)^2 + 2*y^2"},
      {"x^2 + y^2 + 1", "abs(x - y)"},
      {"x^2 + y^2", "1 + 0*x"}};
  for (const auto& [first, second] : cases) {
    const ParetoFront found = front_of(formulas(first, second));
    ASSERT_EQ(found.points.size(), 1u) << first << ", " << second;
    EXPECT_EQ(found.points[0].result.status, Status::verified)
        << first << ", " << second << ": " << found.points[0].result.message;
    EXPECT_FALSE(found.gaps.largest);
  }
}

TEST(TradeOff, HasNoGapWhereNoDesignKeepsTheLimits) {
  const ParetoFront found = front_of(formulas(
      "x^2 + y^2", "(x - 1)^2 + y^2", R"("constraints": {"c": {"response": "f", "upper": -1}},)"));
  EXPECT_FALSE(found.gaps.largest);
  for (const ParetoPoint& point : found.points) EXPECT_FALSE(point.keeps_limits());
}

TEST(TradeOff, IsBetweenTwoResponses) {
  for (const char* responses : {R"("mass", "mass")", R"("mass")", R"("mass", "sack")",
                                R"("mass", {"minimize": "slack", "maximize": "slack"})"}) {
    EXPECT_THROW(square_bar(responses, 3), InputError) << responses;
  }
}

}  // namespace
}  // namespace pleuel::test::choice_front_test
