#include "studies/pareto.hpp"

#include <utility>

#include <nlohmann/json.hpp>

#include "core/base/error.hpp"
#include "optimization/design/design_problem.hpp"
#include "optimization/design/design_solve.hpp"
#include "tests/studies/quick_problem.hpp"
#include "tests/support/evaluation_memory.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::pareto_test {
namespace {

const std::vector<std::string> four_points = {"/pareto/points=4"};

std::vector<ParetoPoint> front(const ProblemFile& problem) {
  return pareto_front(problem, {.backend = problem.optimizer.backend}).points;
}

TEST(Pareto, BeginsWithTheOptimumOfItsFirstLimitAndMoreRoomNeverCostsMass) {
  const ProblemFile problem = quick_problem(four_points);
  const std::vector<ParetoPoint> points = front(problem);
  ASSERT_EQ(points.size(), 4u);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_EQ(points[i].result.status, Status::verified) << points[i].result.message;
    EXPECT_FALSE(points[i].is_dominated);
    if (i == 0) continue;
    EXPECT_GT(points[i].limit, points[i - 1].limit);
    // 1e-6 is the tolerance of the optimizer.
    EXPECT_LE(points[i].result.evaluation.objective,
              points[i - 1].result.evaluation.objective * (1 + 1e-6));
  }
  ProblemFile limited = problem;
  for (ConstraintSettings& constraint : limited.constraints) {
    if (constraint.name == problem.pareto->constraint) constraint.upper = problem.pareto->from;
  }
  DesignProblem design(limited);
  const Result alone = solve_design(design, {.backend = problem.optimizer.backend});
  EXPECT_DOUBLE_EQ(points[0].result.evaluation.objective, alone.evaluation.objective);
  // Ends start from the file, others from the optimum at the nearer end of their gap.
  const auto start = [&](std::size_t i) { return points[i].result.history.front().x; };
  EXPECT_EQ(start(0), start_design(problem));
  EXPECT_EQ(start(3), start_design(problem));
  EXPECT_EQ(start(1), points[0].result.x);
  EXPECT_EQ(start(2), points[3].result.x);  // of the gap from 1 to 3, whose ends are as near
}

TEST(Pareto, MultiplierIsTheSlopeOfTheFront) {
  const ProblemFile problem =
      quick_problem({"/pareto/points=3", "/pareto/from=0.02 mm", "/pareto/to=0.0202 mm"});
  const std::vector<ParetoPoint> points = front(problem);
  ASSERT_GT(points[1].multiplier, 0.0) << "the limit is not active: the test says nothing";
  const double slope =
      (points[2].result.evaluation.objective - points[0].result.evaluation.objective) /
      (points[2].limit - points[0].limit);
  // Central difference over 1 %: its error is of second order, well below 1e-2.
  EXPECT_NEAR(-slope / points[1].multiplier, 1.0, 1e-2);
}

TEST(Pareto, EqualDesignsDoNotDominateEachOther) {
  // At five metres the limit plays no part: both points are the same design.
  const ProblemFile problem =
      quick_problem({"/pareto/points=2", "/pareto/from=5 m", "/pareto/to=6 m"});
  for (const ParetoPoint& point : front(problem)) {
    EXPECT_FALSE(point.is_dominated);
    EXPECT_EQ(point.multiplier, 0.0);
  }
}

/// A point with this objective and limited value that ended so.
ParetoPoint point(double objective, double limited, Status status = Status::verified) {
  ParetoPoint point;
  point.limit = point.limited_value = limited;
  point.result.status = status;
  point.result.evaluation.objective = objective;
  return point;
}

/// The marks of points, as a text of 0 and 1.
std::string dominated(std::vector<ParetoPoint> points, GoodSide side = GoodSide::low) {
  mark_dominated(points, side);
  std::string marks;
  for (const ParetoPoint& marked : points) marks += marked.is_dominated ? '1' : '0';
  return marks;
}

TEST(Dominance, MarksPointsThatAreWorseInOneGoalAndBetterInNone) {
  // Below an upper limit (2, 2) is worse than (1, 2) and (2, 1); above a lower one (1, 2) is best.
  const std::vector<ParetoPoint> points = {point(1.0, 2.0), point(2.0, 1.0), point(2.0, 2.0)};
  EXPECT_EQ(dominated(points, GoodSide::low), "001");
  EXPECT_EQ(dominated(points, GoodSide::high), "011");
  // Only among designs within their limits.
  EXPECT_EQ(dominated({point(1.0, 1.0, Status::infeasible), point(2.0, 2.0),
                       point(3.0, 3.0, Status::failed), point(4.0, 4.0, Status::stalled)}),
            "0001");
}

/// Searches end within 1e-6: half of that is no difference, twice that is one. On a front from
/// (0, 10) to (10, 0), 1e-4 of its length is 1e-3 in both goals.
TEST(Dominance, NeedsMoreThanTheAccuracyOfOptimaAndASmallPartOfTheFront) {
  EXPECT_EQ(dominated({point(1.0, 2.0), point(1.0000005, 2.0)}), "00");
  EXPECT_EQ(dominated({point(1.0, 2.0), point(1.000002, 2.0)}), "01");
  EXPECT_EQ(dominated({point(1.0, 2.0), point(1.0, 2.000004)}), "01");
  for (const auto& [more, expected] : {std::pair{5e-4, "0000"}, {2e-3, "0001"}}) {
    EXPECT_EQ(
        dominated({point(0.0, 10.0), point(10.0, 0.0), point(5.0, 5.0), point(5.0 + more, 5.0)}),
        expected);
  }
  // A limited goal that falls by decades buys much of the objective for little of its range.
  EXPECT_EQ(dominated({point(0.0, 1.0), point(0.24, 5e-5), point(0.48, 1e-6), point(0.85, 1e-8)}),
            "0000");
}

/// Neighbours on a quarter of a circle, ever nearer to both ends, where one goal hardly changes: 1e-6
/// of its range, and more than its round-off where it is large.
TEST(Dominance, DoesNotDependOnHowLargeGoalsAreBesideTheirRange) {
  for (const double offset : {0.0, 1.0, 1e2, -1e3}) {
    std::vector<ParetoPoint> points;
    for (const double angle : {0.0, 2e-3, 0.01, 0.1, 0.5, 1.0, 1.4, 1.56, 1.5688, 1.5707963}) {
      points.push_back(point(offset + 1.0 - std::sin(angle), offset + 1.0 - std::cos(angle)));
    }
    points.push_back(point(offset + 0.6, offset + 0.6));  // the circle is at 0.29
    EXPECT_EQ(dominated(points), "00000000001") << offset;
  }
}

/// Of two searches with one limit, which both miss by 1e-7, the better one counts.
TEST(Dominance, TakesDesignsWithTheSameLimitAsKeepingItAlike) {
  ParetoPoint better = point(1.0, 2.0000002), worse = point(1.5, 2.0000001);
  better.limit = worse.limit = 2.0;
  EXPECT_EQ(dominated({better, worse}), "01");
  better.limit = 2.1;
  EXPECT_EQ(dominated({better, worse}), "00");
}

/// The rod is as thin as it may be. m = ρ π/4 d² l and so dm/dd = ρ π/2 d l: 7850 kg/m³, 180 mm.
TEST(Pareto, OverALowerLimitHasMultipliersOfTheOtherSign) {
  const ProblemFile problem = quick_problem(
      {R"(/constraints={"rod_size": {"linear": {"rod_diameter": 1}, "lower": "20 mm"}})",
       R"(/variables/crank_diameter={"start": "30 mm", "lower": "30 mm", "upper": "30 mm"})",
       R"(/pareto={"constraint": "rod_size", "from": "20 mm", "to": "30 mm", "points": 3})"});
  for (const ParetoPoint& point : front(problem)) {
    EXPECT_EQ(point.result.status, Status::verified) << point.result.message;
    EXPECT_NEAR(point.limited_value, point.limit, 1e-6 * point.limit);
    const double slope = 7850.0 * 1.5707963267948966 * point.limit * 0.180;
    EXPECT_NEAR(point.multiplier, -slope, 1e-4 * slope);
    // A thicker rod is heavier, but what is large is good.
    EXPECT_FALSE(point.is_dominated);
  }
}

TEST(Pareto, DoesNotDependOnTheNumberOfJobs) {
  const ProblemFile problem = quick_problem(four_points);
  SolveOptions options{.backend = problem.optimizer.backend};
  std::vector<double> limits;
  const ParetoObserver note = [&](const ParetoPoint& point) { limits.push_back(point.limit); };
  const std::vector<ParetoPoint> one = pareto_front(problem, options, {{.jobs = 1}}, note).points;
  const std::vector<double> in_order = std::exchange(limits, {});
  const std::vector<ParetoPoint> three = pareto_front(problem, options, {{.jobs = 3}}, note).points;
  EXPECT_EQ(limits, in_order);
  ASSERT_EQ(three.size(), one.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(three[i].limit, one[i].limit);
    EXPECT_EQ(three[i].result.x, one[i].result.x);
    EXPECT_EQ(three[i].result.evaluations, one[i].result.evaluations);
    EXPECT_EQ(three[i].multiplier, one[i].multiplier);
  }
}

TEST(ParetoOrder, HasEachPointOnceAndFewThatWaitForEachOther) {
  for (const int points : {1, 2, 3, 7, 16, 40}) {
    const ParetoOrder order = pareto_order(points);
    std::vector<int> sorted = order.points;
    std::sort(sorted.begin(), sorted.end());
    ASSERT_EQ(sorted.size(), static_cast<std::size_t>(points));
    for (int i = 0; i < points; ++i) EXPECT_EQ(sorted[i], i);
    std::vector<int> depths;
    for (std::size_t i = 0; i < order.points.size(); ++i) {
      const auto from = order.from[i];
      if (i < 2) {
        EXPECT_FALSE(from.has_value());
        depths.push_back(1);
        continue;
      }
      ASSERT_TRUE(from && static_cast<std::size_t>(*from) < i);
      depths.push_back(depths[*from] + 1);
    }
    // log2 of the points: the longest row of points that wait for each other.
    EXPECT_LE(*std::max_element(depths.begin(), depths.end()), 2 + std::log2(points));
  }
  EXPECT_EQ(pareto_order(5).points, (std::vector<int>{0, 4, 2, 1, 3}));
}

TEST(Pareto, WithoutSettingsThereIsNothingToVary) {
  ProblemFile problem = quick_problem();
  problem.pareto.reset();
  EXPECT_THROW(pareto_front(problem, {}), InputError);
}

// Fronts of files with load cases, against closed forms.

using Json = nlohmann::ordered_json;

/// A number x, its square and the square of its distance from a target, which is 1 in the case "near"
/// and 3 in the case "far". What is simulated does not matter.
Json distances(const std::string& pareto) {
  Json document = Json::parse(R"json({
    "constants": {"target": 1},
    "scene": {"bodies": {"stone": {"type": "rigid", "at": [0, 0, 0], "mass": 1, "inertia": [1, 1, 1, 0, 0, 0]}},
              "joints": {"floor": {"type": "fixed", "bodies": ["ground", "stone"], "at": [0, 0, 0]}}},
    "simulation": {"end_time": "2 s", "step": "1 s", "resolution_check": false},
    "sensitivity": {"method": "direct"},
    "variables": {"x": {"start": 1.3, "lower": 0.5, "upper": 10}},
    "responses": {"distance": {"type": "expression", "value": "(x - target)^2"},
                  "cost": {"type": "expression", "value": "x^2"}},
    "objective": {"minimize": "= cost[near]"},
    "constraints": {"reach": {"response": "distance", "upper": 9}},
    "cases": {"near": {}, "far": {"/constants/target": 3}}
  })json");
  document["pareto"] = Json::parse(pareto);
  return document;
}

std::vector<ParetoPoint> case_front(const Json& document, int jobs = 1,
                                    EvaluationStore* store = nullptr) {
  const ProblemFile file = problem_from(document.dump());
  return pareto_front(trade_off_problem(file), {}, {{.jobs = jobs}, store}).points;
}

/// Fronts whose points all are verified.
std::vector<ParetoPoint> verified_front(const std::string& pareto, std::size_t count) {
  const auto points = case_front(distances(pareto));
  EXPECT_EQ(points.size(), count);
  for (const ParetoPoint& point : points) {
    EXPECT_EQ(point.result.status, Status::verified) << point.result.message;
  }
  return points;
}

TEST(ParetoOverCases, MovesALimitInOneOfThem) {
  const auto points =
      verified_front(R"({"constraint": "reach[near]", "from": 0.04, "to": 0.16, "points": 2})", 2);
  EXPECT_NEAR(points.at(0).result.x(0), 0.8,
              1e-4);  // (x − 1)² ≤ limit, (x − 3)² ≤ 9 does not matter
  EXPECT_NEAR(points.at(1).result.x(0), 0.6, 1e-4);
}

TEST(ParetoOverCases, MovesALimitInAllOfThem) {
  for (const ParetoPoint& point :
       verified_front(R"({"constraint": "reach", "from": 1.5, "to": 4, "points": 3})", 3)) {
    const double x = 3.0 - std::sqrt(point.limit);  // (x − 3)² ≤ limit; the other case is nearer
    EXPECT_NEAR(point.result.x(0), x, 1e-4);
    EXPECT_NEAR(point.limited_value, point.limit, 1e-4);
    EXPECT_NEAR(point.multiplier, x / std::sqrt(point.limit), 1e-3);  // −dx²/dlimit
  }
}

TEST(ParetoOverCases, TradesTheWorstOfAllCases) {
  const auto points =
      verified_front(R"({"responses": [{"maximize": "cost[near]"}, "distance"], "points": 5})", 5);
  // From x = 4 (the limit "reach" in the case "near") down to x = 2, where both cases tie.
  EXPECT_NEAR(points.front().result.x(0), 4.0, 1e-2);
  EXPECT_NEAR(points.back().result.x(0), 2.0, 1e-2);
  for (const ParetoPoint& point : points) {
    EXPECT_NEAR(point.result.x(0), 1.0 + std::sqrt(point.limit), 1e-2) << point.limit;
    EXPECT_NEAR(point.limited_value, point.limit, 1e-2 * point.limit);
  }
}

TEST(ParetoOverCases, TradesResponsesOfTwoCases) {
  for (const ParetoPoint& point :
       verified_front(R"({"responses": ["distance[near]", "distance [far]"], "points": 5})", 5)) {
    // √a + √b = 2 between both targets
    EXPECT_NEAR(std::sqrt(point.result.evaluation.objective) + std::sqrt(point.limited_value), 2.0,
                2e-2);
  }
}

TEST(ParetoOverCases, TradesASumOverThem) {
  for (const ParetoPoint& point : verified_front(
           R"({"responses": ["cost[near]", {"minimize": "distance", "over_cases": "sum"}],
               "points": 4})",
           4)) {
    const double x = point.result.x(0);  // (x − 1)² + (x − 3)² = 2 (x − 2)² + 2
    EXPECT_NEAR(point.limited_value, 2.0 * (x - 2.0) * (x - 2.0) + 2.0, 1e-6);
    EXPECT_NEAR(x, 2.0 - std::sqrt(0.5 * (point.limit - 2.0)), 1e-2);
  }
}

TEST(ParetoOverCases, HasTheObjectiveOverCasesWhereItTradesThat) {
  Json document = distances(R"({"responses": ["distance", "cost[near]"], "points": 3})");
  document["objective"] = {{"minimize", "distance"}, {"over_cases", {{"near", 3}, {"far", 1}}}};
  const ProblemFile problem = trade_off_problem(problem_from(document.dump()));
  EXPECT_EQ(problem.objective->response, "distance [weighted]");
  const auto points = case_front(document);
  // 6 (x − 1) + 2 (x − 3) = 0. An end may miss its goal, 3 + 4 (x − 1.5)², by 1e-4 of its value: by
  // 0.009 in x.
  EXPECT_NEAR(points.front().result.x(0), 1.5, 1e-2);
}

TEST(ParetoOverCases, HasTheSamePointsWhateverTheNumberOfJobs) {
  const Json document = distances(R"({"responses": ["distance", "cost[near]"], "points": 5})");
  const auto one = case_front(document, 1), two = case_front(document, 2);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].result.x, two[i].result.x) << i;
    EXPECT_EQ(one[i].limited_value, two[i].limited_value);
    EXPECT_EQ(one[i].multiplier, two[i].multiplier);
    EXPECT_EQ(one[i].result.evaluations, two[i].result.evaluations);
  }
}

/// Both ends begin at one design with another objective each: what is kept of one is not the other's.
TEST(ParetoOverCases, GoesOnFromItsRecordWithTheSameDigits) {
  for (const char* goals :
       {R"(["distance", "cost[near]"])", R"(["cost[near]", "distance[far]"])"}) {
    const Json document = distances(R"({"points": 3, "responses": )" + std::string(goals) + "}");
    EvaluationMemory memory;
    const auto without = case_front(document), first = case_front(document, 1, &memory);
    const int made = memory.made;
    const auto again = case_front(document, 1, &memory);
    EXPECT_EQ(memory.made, made);  // nothing is simulated a second time
    ASSERT_EQ(first.size(), again.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
      EXPECT_EQ(first[i].result.x, without[i].result.x) << i;
      EXPECT_EQ(first[i].result.x, again[i].result.x) << i;
      EXPECT_EQ(first[i].result.evaluation.objective, again[i].result.evaluation.objective);
    }
  }
}

TEST(ParetoOverCases, SaysWhichNamesThereAre) {
  for (const auto& [pareto, place, name] :
       {std::tuple{R"({"responses": ["distance[nera]", "cost[near]"]})", "/pareto/responses/0",
                   "\"distance [near]\""},
        {R"({"constraint": "reach[fra]", "from": 1, "to": 2})", "/pareto/constraint",
         "reach [far]"},
        {R"({"responses": [{"minimize": "distance", "over_cases": {"nah": 1}}, "cost[near]"]})",
         "/pareto/responses/0/over_cases/nah", "near"},
        {R"({"responses": [{"minimize": "distance[near]", "over_cases": "sum"}, "cost[near]"]})",
         "/pareto/responses/0/over_cases", ""}}) {
    EXPECT_THAT(thrown<InputError>([&, text = pareto] { problem_from(distances(text).dump()); }),
                AllOf(HasSubstr(place), HasSubstr(name)));
  }
}

}  // namespace
}  // namespace pleuel::test::pareto_test
