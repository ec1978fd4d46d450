#include <limits>

#include "core/base/error.hpp"
#include "studies/pareto.hpp"
#include "studies/pareto_point.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

/// Fronts of sizes from lists.
namespace pleuel::test::choice_front_test {
namespace {

constexpr double density = 7850.0;
const std::vector<double> widths = {0.02, 0.03, 0.045}, heights = {0.025, 0.04, 0.05, 0.06};

std::string mm_list(const std::vector<double>& sizes) {
  std::string text;
  for (const double size : sizes)
    text += fmt::format("{}\"{} mm\"", text.empty() ? "" : ", ", 1e3 * size);
  return text;
}

/// A bar of 1 m, width b and height h from lists: its mass is ρ b h. The response "slack" is 1/(b
/// h²) with 10⁻⁵ m³, and a tenth of a length that may be designed, too.
ProblemFile bar(const std::string& pareto, const std::string& extra = R"({"start": "0.5 m",
                "lower": "0.5 m", "upper": "0.5 m"})",
                const std::string& more = "") {
  return problem_from(
      fmt::format(R"({{"scene": {{"bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0],
    "to": [1, 0, 0], "rigid": true, "material": "steel", "elements": 1,
    "section": {{"type": "rectangle", "width": {{"variable": "b"}}, "height": {{"variable": "h"}}}}}}}},
    "joints": {{"wall": {{"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}}}}}},
  "simulation": {{"end_time": "2 ms", "step": "1 ms", "resolution_check": false}},
  "variables": {{"b": {{"choices": [{}]}}, "h": {{"choices": [{}]}}, "extra": {}}},
  "responses": {{"mass": {{"type": "mass"}},
    "slack": {{"type": "expression", "value": "extra/(10 m) + 1e-5*(1 m)/b*((1 m)/h)^2"}},
    "goodness": {{"type": "expression", "value": "0 - slack"}}}},
  {} "pareto": {}}})",
                  mm_list(widths), mm_list(heights), extra, more, pareto));
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

TEST(ChoiceFront, IsThatOfAllChoices) {
  const std::vector<Bar> best = best_bars();
  ASSERT_GT(best.size(), 3u);
  ASSERT_LT(best.size(), widths.size() * heights.size()) << "none is dominated: it says little";
  const ParetoFront front = front_of(bar(R"({"responses": ["mass", "slack"]})"));
  expect_bars(front.points, best);
  ASSERT_TRUE(front.choices);
  EXPECT_EQ(front.choices->all, 12);
  EXPECT_EQ(front.choices->feasible, 12);
  EXPECT_EQ(front.choices->failed, 0);
  EXPECT_TRUE(front.is_whole);
}

TEST(ChoiceFront, OfWhatIsMaximizedIsThatOfTheNegative) {
  const ParetoFront front = front_of(bar(R"({"responses": ["mass", {"maximize": "goodness"}]})"));
  const ParetoFront low = front_of(bar(R"({"responses": ["mass", "slack"]})"));
  ASSERT_EQ(front.points.size(), low.points.size());
  for (std::size_t i = 0; i < low.points.size(); ++i) {
    EXPECT_EQ(front.points[i].result.x, low.points[i].result.x);
  }
}

TEST(ChoiceFront, IsTheSameForAnyNumberOfJobs) {
  const ProblemFile file = bar(R"({"responses": ["mass", "slack"]})");
  const ParetoFront one = front_of(file, 1), three = front_of(file, 3);
  ASSERT_EQ(one.points.size(), three.points.size());
  for (std::size_t i = 0; i < one.points.size(); ++i) {
    EXPECT_EQ(one.points[i].limited_value, three.points[i].limited_value);
  }
}

constexpr const char* slack_limit =
    R"("objective": {"minimize": "mass"}, "constraints": {"loose": {"response": "slack", "upper": 0.4}},)";

/// The best for the tight end is the loosest within it, and the front ends at the loose end.
TEST(ChoiceFront, OverALimitIsWhatIsBestBetweenItsEnds) {
  const std::vector<Bar> best = best_bars();
  const double tight = 0.5 * (slack(best[1].b, best[1].h) + slack(best[2].b, best[2].h));
  const double loose = slack(best[4].b, best[4].h) * 1.001;
  for (const bool is_turned : {false, true}) {
    const ParetoFront front =
        front_of(bar(fmt::format(R"({{"constraint": "loose", "from": {}, "to": {}}})",
                                 is_turned ? loose : tight, is_turned ? tight : loose),
                     R"({"start": "0.5 m", "lower": "0.5 m", "upper": "0.5 m"})", slack_limit));
    expect_bars(front.points, {best[1], best[2], best[3], best[4]});
  }
}

TEST(ChoiceFront, KeepsTheOtherLimits) {
  const double most = slack(best_bars()[2].b, best_bars()[2].h) * 1.001;
  const ParetoFront front = front_of(
      bar(R"({"responses": ["mass", "slack"]})",
          R"({"start": "0.5 m", "lower": "0.5 m", "upper": "0.5 m"})",
          fmt::format(R"("constraints": {{"own": {{"response": "slack", "upper": {}}}}},)", most)));
  expect_bars(front.points, {best_bars()[0], best_bars()[1], best_bars()[2]});
}

TEST(ChoiceFront, HasNoPointWhereNoChoiceKeepsTheLimits) {
  const ParetoFront front =
      front_of(bar(R"({"responses": ["mass", "slack"]})",
                   R"({"start": "0.5 m", "lower": "0.5 m", "upper": "0.5 m"})",
                   R"("constraints": {"own": {"response": "slack", "upper": 0.01}},)"));
  EXPECT_TRUE(front.points.empty());
  EXPECT_EQ(front.choices->feasible, 0);
}

/// Bars of 32 mm to 38 mm have no value of the square root.
TEST(ChoiceFront, LeavesOutWhatCannotBeSimulated) {
  const std::string begin = R"json({"scene": {"bodies": {"bar": {"type": "beam",
    "from": [0, 0, 0], "to": [1, 0, 0], "rigid": true, "material": "steel", "elements": 1,
    "section": {"type": "rectangle", "width": {"variable": "a"}, "height": {"variable": "a"}}}},
    "joints": {"wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}}},
    "simulation": {"end_time": "2 ms", "step": "1 ms", "resolution_check": false},
    "variables": {"a": {"choices": [)json";
  const std::string end = R"json(]}}, "responses": {"mass": {"type": "mass"}, "slack": {
    "type": "expression", "value": "((60 mm)/a)^2 + 0*sqrt((a/(1 mm) - 35)^2 - 9)"}},
    "pareto": {"responses": ["mass", "slack"]}})json";
  const auto front_with = [&](const char* sizes) {
    return front_of(problem_from(begin + sizes + end));
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
      front_of(bar(R"({"constraint": "loose", "from": 0.15, "to": 0.45, "points": 4})",
                   R"({"start": "0.7 m", "lower": "0.5 m", "upper": "1 m"})", slack_limit),
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
  const ParetoFront front =
      front_of(bar(R"({"responses": ["mass", "slack"], "points": 3})",
                   R"({"start": "0.7 m", "lower": "0.5 m", "upper": "1 m"})"));
  ASSERT_EQ(front.points.size(), 3u);
  EXPECT_NEAR(front.points.front().result.evaluation.objective, density * 0.02 * 0.025, 1e-6);
  EXPECT_NEAR(front.points.back().limited_value, slack(0.045, 0.06), 1e-4);
}

/// 12 choices are all tried beside another variable; of 18 · 18, more than can be simulated, some are.
TEST(ChoiceFront, SaysWhetherAllChoicesWereTriedForAPoint) {
  const ParetoFront few = front_of(bar(R"({"responses": ["mass", "slack"], "points": 3})",
                                       R"({"start": "0.7 m", "lower": "0.5 m", "upper": "1 m"})"));
  for (const ParetoPoint& point : few.points) {
    ASSERT_TRUE(point.sizes);
    EXPECT_TRUE(point.sizes->is_exhaustive);
    EXPECT_EQ(point.sizes->tried, 12);
  }
  ProblemFile many = bar(R"({"responses": ["mass", "slack"], "points": 3})");
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
  const ProblemFile file = bar(R"({"responses": ["mass", "slack"], "gap": 0.1})",
                               R"({"start": "0.7 m", "lower": "0.5 m", "upper": "1 m"})");
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

}  // namespace
}  // namespace pleuel::test::choice_front_test
