#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/base/error.hpp"
#include "core/scene/problem_reader.hpp"
#include "studies/pareto.hpp"
#include "tests/support/evaluation_memory.hpp"

/// Fronts of files with load cases, against closed forms.
namespace pleuel::test::pareto_cases_test {
namespace {

using Json = nlohmann::ordered_json;

/// A number x, its square and the square of its distance from a target, which is 1 in the case "near"
/// and 3 in the case "far". What is simulated does not matter.
Json distances(const std::string& pareto) {
  Json document = Json::parse(R"json({
    "constants": {"target": 1},
    "scene": {"bodies": {"stone": {"type": "rigid", "at": [0, 0, 0], "mass": 1,
                                   "inertia": [1, 1, 1, 0, 0, 0]}},
              "joints": {"floor": {"type": "fixed", "bodies": ["ground", "stone"],
                                   "at": [0, 0, 0]}}},
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

std::vector<ParetoPoint> front(const Json& document, int jobs = 1,
                               EvaluationStore* store = nullptr) {
  const ProblemFile file = read_problem_text(document.dump(), "cases.json").complete();
  return pareto_front(trade_off_problem(file), {}, {{.jobs = jobs}, store}).points;
}

TEST(ParetoOverCases, MovesALimitInAllOfThem) {
  const auto points =
      front(distances(R"({"constraint": "reach", "from": 1.5, "to": 4, "points": 3})"));
  ASSERT_EQ(points.size(), 3u);
  for (const ParetoPoint& point : points) {
    EXPECT_EQ(point.result.status, Status::verified) << point.result.message;
    const double x = 3.0 - std::sqrt(point.limit);  // (x − 3)² ≤ limit; the other case is nearer
    EXPECT_NEAR(point.result.x(0), x, 1e-4);
    EXPECT_NEAR(point.limited_value, point.limit, 1e-4);
    EXPECT_NEAR(point.multiplier, x / std::sqrt(point.limit), 1e-3);  // −dx²/dlimit
  }
}

TEST(ParetoOverCases, MovesALimitInOneOfThem) {
  const auto points =
      front(distances(R"({"constraint": "reach[near]", "from": 0.04, "to": 0.16, "points": 2})"));
  ASSERT_EQ(points.size(), 2u);
  EXPECT_NEAR(points[0].result.x(0), 0.8, 1e-4);  // (x − 1)² ≤ limit, (x − 3)² ≤ 9 does not matter
  EXPECT_NEAR(points[1].result.x(0), 0.6, 1e-4);
}

TEST(ParetoOverCases, TradesTheWorstOfAllCases) {
  const auto points =
      front(distances(R"({"responses": [{"maximize": "cost[near]"}, "distance"], "points": 5})"));
  ASSERT_EQ(points.size(), 5u);
  // From x = 4 (the limit "reach" in the case "near") down to x = 2, where both cases tie.
  EXPECT_NEAR(points.front().result.x(0), 4.0, 1e-2);
  EXPECT_NEAR(points.back().result.x(0), 2.0, 1e-2);
  for (const ParetoPoint& point : points) {
    EXPECT_EQ(point.result.status, Status::verified) << point.result.message;
    EXPECT_NEAR(point.result.x(0), 1.0 + std::sqrt(point.limit), 1e-2) << point.limit;
    EXPECT_NEAR(point.limited_value, point.limit, 1e-2 * point.limit);
  }
}

TEST(ParetoOverCases, TradesResponsesOfTwoCases) {
  const auto points =
      front(distances(R"({"responses": ["distance[near]", "distance [far]"], "points": 5})"));
  ASSERT_EQ(points.size(), 5u);
  for (const ParetoPoint& point : points) {
    EXPECT_EQ(point.result.status, Status::verified) << point.result.message;
    // √a + √b = 2 between both targets
    EXPECT_NEAR(std::sqrt(point.result.evaluation.objective) + std::sqrt(point.limited_value), 2.0,
                2e-2);
  }
}

TEST(ParetoOverCases, TradesASumOverThem) {
  const auto points = front(distances(
      R"({"responses": ["cost[near]", {"minimize": "distance", "over_cases": "sum"}],
          "points": 4})"));
  ASSERT_EQ(points.size(), 4u);
  for (const ParetoPoint& point : points) {
    EXPECT_EQ(point.result.status, Status::verified) << point.result.message;
    const double x = point.result.x(0);  // (x − 1)² + (x − 3)² = 2 (x − 2)² + 2
    EXPECT_NEAR(point.limited_value, 2.0 * (x - 2.0) * (x - 2.0) + 2.0, 1e-6);
    EXPECT_NEAR(x, 2.0 - std::sqrt(0.5 * (point.limit - 2.0)), 1e-2);
  }
}

TEST(ParetoOverCases, HasTheObjectiveOverCasesWhereItTradesThat) {
  Json document = distances(R"({"responses": ["distance", "cost[near]"], "points": 3})");
  document["objective"] = {{"minimize", "distance"}, {"over_cases", {{"near", 3}, {"far", 1}}}};
  const ProblemFile problem =
      trade_off_problem(read_problem_text(document.dump(), "cases.json").complete());
  EXPECT_EQ(problem.objective->response, "distance [weighted]");
  const auto points = front(document);
  // 6 (x − 1) + 2 (x − 3) = 0. An end may miss its goal, 3 + 4 (x − 1.5)², by 1e-4 of its value: by
  // 0.009 in x.
  EXPECT_NEAR(points.front().result.x(0), 1.5, 1e-2);
}

TEST(ParetoOverCases, HasTheSamePointsWhateverTheNumberOfJobs) {
  const Json document = distances(R"({"responses": ["distance", "cost[near]"], "points": 5})");
  const auto one = front(document, 1), two = front(document, 2);
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
    const auto without = front(document), first = front(document, 1, &memory);
    const int made = memory.made;
    const auto again = front(document, 1, &memory);
    EXPECT_EQ(memory.made, made);  // nothing is simulated a second time
    ASSERT_EQ(first.size(), again.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
      EXPECT_EQ(first[i].result.x, without[i].result.x) << i;
      EXPECT_EQ(first[i].result.x, again[i].result.x) << i;
      EXPECT_EQ(first[i].result.evaluation.objective, again[i].result.evaluation.objective);
    }
  }
}

std::string complaint(const std::string& pareto) {
  try {
    read_problem_text(distances(pareto).dump(), "cases.json").complete();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ParetoOverCases, SaysWhichNamesThereAre) {
  using testing::AllOf;
  using testing::HasSubstr;
  EXPECT_THAT(complaint(R"({"responses": ["distance[nera]", "cost[near]"]})"),
              AllOf(HasSubstr("/pareto/responses/0"), HasSubstr("\"distance [near]\"")));
  EXPECT_THAT(complaint(R"({"constraint": "reach[fra]", "from": 1, "to": 2})"),
              AllOf(HasSubstr("/pareto/constraint"), HasSubstr("reach [far]")));
  EXPECT_THAT(complaint(R"({"responses": [{"minimize": "distance", "over_cases": {"nah": 1}},
                                          "cost[near]"]})"),
              AllOf(HasSubstr("/pareto/responses/0/over_cases/nah"), HasSubstr("near")));
  EXPECT_THAT(complaint(R"({"responses": [{"minimize": "distance[near]", "over_cases": "sum"},
                                          "cost[near]"]})"),
              HasSubstr("/pareto/responses/0/over_cases"));
}

}  // namespace
}  // namespace pleuel::test::pareto_cases_test
