#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/base/eager_matrices.hpp"
#include "core/jobs/parallel.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/problem_reader.hpp"
#include "optimization/design/design_solve.hpp"
#include "optimization/design/peak_problem.hpp"
#include "optimization/design/staged_solve.hpp"
#include "tests/problems/loaded_crank.hpp"
#include "tests/support/evaluation_memory.hpp"
#include "tests/support/problem_runs.hpp"

/// Load cases: closed forms of numbers over cases, and a mechanism against two copies of it.
namespace pleuel::test::load_case_test {
namespace {

using Json = nlohmann::ordered_json;

ProblemFile problem_of(const Json& document) {
  return read_problem_text(document.dump(), "cases.json").complete();
}

/// A stone on the floor and a number x whose distance from a target is squared: the target is that
/// of the case.
Json distances() {
  return Json::parse(R"json({
    "constants": {"target": 1},
    "scene": {"bodies": {"stone": {"type": "rigid", "at": [0, 0, 0], "mass": 1,
                                   "inertia": [1, 1, 1, 0, 0, 0]}},
              "joints": {"floor": {"type": "fixed", "bodies": ["ground", "stone"],
                                   "at": [0, 0, 0]}}},
    "simulation": {"end_time": "2 s", "step": "1 s"},
    "variables": {"x": {"start": 2.7, "lower": -10, "upper": 10}},
    "responses": {"distance": {"type": "expression", "value": "(x - target)^2"}},
    "objective": {"minimize": "distance", "over_cases": "worst"},
    "constraints": {},
    "cases": {"near": {}, "far": {"/constants/target": 3}, "middle": {"/constants/target": 2}}
  })json");
}

TEST(LoadCases, MeetHalfWayWhereTheWorstIsMinimized) {
  DesignProblem design(problem_of(distances()));
  const Result result = solve_design(design, {});
  EXPECT_EQ(result.status, Status::verified) << result.message;
  EXPECT_NEAR(result.x(0), 2.0, 1e-4);  // max((x − 1)², (x − 3)²) is least there
  EXPECT_NEAR(result.evaluation.objective, 1.0, 1e-4);
  ASSERT_EQ(result.case_shares.size(), 3);
  EXPECT_NEAR(result.case_shares(0), 0.5, 1e-3);  // of both slopes, ±2: they cancel
  EXPECT_NEAR(result.case_shares(1), 0.5, 1e-3);
  EXPECT_NEAR(result.case_shares(2), 0.0, 1e-6);
  EXPECT_NEAR(result.case_objectives(2), 0.0, 1e-6);
}

TEST(LoadCases, AreWeighedInASum) {
  Json document = distances();
  document["objective"]["over_cases"] = {{"near", 3}, {"far", 1}};
  DesignProblem design(problem_of(document));
  const Result result = solve_design(design, {});
  EXPECT_EQ(result.status, Status::verified) << result.message;
  EXPECT_NEAR(result.x(0), 1.5, 1e-4);                  // 6 (x − 1) + 2 (x − 3) = 0
  EXPECT_NEAR(result.evaluation.objective, 3.0, 1e-4);  // 3 · 0.5² + 1.5²
}

TEST(LoadCases, HaveTheSmallestNumberAsTheWorstOfWhatIsMaximized) {
  Json document = distances();
  document["responses"]["distance"]["value"] = "-(x - target)^2";
  document["objective"] = {{"maximize", "distance"}, {"over_cases", "worst"}};
  DesignProblem design(problem_of(document));
  const Result result = solve_design(design, {});
  EXPECT_EQ(result.status, Status::verified) << result.message;
  EXPECT_NEAR(result.x(0), 2.0, 1e-4);
  EXPECT_NEAR(-result.evaluation.objective, -1.0, 1e-4);
}

TEST(LoadCases, HoldALimitInThoseThatItNames) {
  Json document = distances();
  document["responses"]["cost"] = {{"type", "expression"}, {"value", "x^2"}};
  document["objective"] = {{"minimize", "cost"}, {"over_cases", {{"near", 1}}}};
  document["constraints"]["reach"] = {{"response", "distance"}, {"upper", 0.25}};
  document["cases"].erase("middle");
  document["constraints"]["reach"]["cases"] = {"far"};
  DesignProblem far(problem_of(document));
  EXPECT_NEAR(solve_design(far, {}).x(0), 2.5, 1e-4);  // (x − 3)² ≤ 1/4
  document["constraints"]["reach"]["cases"] = {"near"};
  DesignProblem near(problem_of(document));
  EXPECT_NEAR(solve_design(near, {}).x(0), 0.5, 1e-4);  // (x − 1)² ≤ 1/4
}

/// Both cases as two mechanisms in one scene, with the limits of each.
Json twins() {
  Json document = test::loaded_crank();
  Json& scene = document["scene"];
  Json bodies, joints, responses, constraints;
  for (const std::string& name : {std::string("fast"), std::string("heavy")}) {
    Json crank_body = scene["bodies"]["crank"], load = scene["bodies"]["load"];
    Json hub = scene["joints"]["hub"], clamp = scene["joints"]["clamp"];
    if (name == "heavy") {
      load["mass"] = "2 kg";
      hub["drive"]["speed"] = "30 rad/s";
    }
    hub["bodies"] = {"ground", "crank_" + name};
    clamp["bodies"] = {"crank_" + name, "load_" + name};
    bodies["crank_" + name] = crank_body;
    bodies["load_" + name] = load;
    joints["hub_" + name] = hub;
    joints["clamp_" + name] = clamp;
    for (const std::string& kind : {std::string("stress"), std::string("tip")}) {
      Json response = document["responses"][kind];
      response["body"] = "crank_" + name;
      responses[kind + "_" + name] = response;
    }
    constraints["strength_" + name] = {{"response", "stress_" + name}, {"upper", "60 MPa"}};
    constraints["stiffness_" + name] = {{"response", "tip_" + name}, {"upper", "0.2 mm"}};
  }
  responses["mass"] = {{"type", "mass"}, {"bodies", {"crank_fast"}}};
  constraints["shape"] = document["constraints"]["shape"];
  scene["bodies"] = bodies;
  scene["joints"] = joints;
  document["responses"] = responses;
  document["constraints"] = constraints;
  document.erase("cases");
  return document;
}

TEST(LoadCases, HaveTheOptimumOfTheMechanismCopiedForEach) {
  DesignProblem cases(problem_of(test::loaded_crank())), copies(problem_of(twins()));
  const Result one = solve_design(cases, {}), other = solve_design(copies, {});
  EXPECT_EQ(one.status, Status::verified) << one.message;
  EXPECT_EQ(other.status, Status::verified) << other.message;
  // Optima are found to 1e-6 of the objective.
  EXPECT_NEAR(one.evaluation.objective, other.evaluation.objective,
              1e-5 * other.evaluation.objective);
  EXPECT_NEAR(one.x(0), other.x(0), 1e-3 * other.x(0));
  EXPECT_NEAR(one.x(1), other.x(1), 1e-3 * other.x(1));
}

TEST(LoadCases, OfTheShippedProblemDecideALimitEach) {
  DesignProblem design(sample_problem("two_loads"));
  const Result result = solve_design(design, {});
  EXPECT_EQ(result.status, Status::verified) << result.message;
  // Found from two starts with nlopt-slsqp, nlopt-mma and ipopt.
  EXPECT_NEAR(result.evaluation.objective, 0.61849, 1e-4);
  std::map<std::string, double> prices;
  for (std::size_t i = 0; i < design.constraints().size(); ++i) {
    prices[design.constraints()[i].name] =
        result.constraint_multipliers(static_cast<Eigen::Index>(i));
  }
  EXPECT_GT(prices.at("crank_strength [heavy]"), 0.0);
  EXPECT_EQ(prices.at("crank_strength [fast]"), 0.0);
  EXPECT_GT(prices.at("rod_stiffness [fast]"), 0.0);
  EXPECT_EQ(prices.at("rod_stiffness [heavy]"), 0.0);
}

TEST(LoadCases, HaveTheValuesAndGradientsOfEachByItself) {
  const ProblemFile file = problem_of(test::loaded_crank());
  DesignProblem design(file);
  const Eigen::VectorXd x = start_design(file);
  const Evaluation all = design.evaluate(x, Request::values_and_gradients);
  for (const std::string name : {"fast", "heavy"}) {
    DesignProblem alone(problem_of_case(file, name));
    const Evaluation one = alone.evaluate(x, Request::values_and_gradients);
    for (std::size_t i = 0; i < alone.constraints().size(); ++i) {
      for (std::size_t j = 0; j < design.constraints().size(); ++j) {
        if (design.constraints()[j].name != name_in_case(alone.constraints()[i].name, name))
          continue;
        EXPECT_EQ(all.constraints(j), one.constraints(i)) << design.constraints()[j].name;
        EXPECT_EQ(all.constraint_jacobian.row(j), one.constraint_jacobian.row(i));
      }
    }
  }
}

TEST(LoadCases, TellPeaksApartInEachOfThem) {
  const ProblemFile file = problem_of(test::loaded_crank());
  DesignProblem design(file);
  PeakProblem peaks(design, 4);
  const Eigen::VectorXd x = start_design(file);
  const Evaluation rows = peaks.evaluate(x, Request::values);
  const Evaluation whole = design.evaluate(x, Request::values);
  const Eigen::VectorXd folded = peaks.fold_values(rows.constraints);
  for (Eigen::Index i = 0; i < whole.constraints.size(); ++i) {
    EXPECT_NEAR(folded(i), whole.constraints(i), 1e-12 * std::abs(whole.constraints(i)));
  }
}

/// Eight speeds with their worst torque.
Json eight_speeds() {
  Json document = test::loaded_crank();
  document["cases"] = Json::parse(R"({"speed": {"range": {
      "/scene/joints/hub/drive/speed": {"from": "20 rad/s", "to": "60 rad/s", "count": 8}}}})");
  document["objective"] = {{"minimize", "torque"}, {"over_cases", "worst"}};
  document["simulation"]["step"] = "1 ms";
  return document;
}

TEST(LoadCases, HaveTheSameDigitsWhateverTheNumberOfJobs) {
  const ProblemFile file = problem_of(eight_speeds());
  ASSERT_EQ(file.cases.size(), 8u);
  DesignProblem one(file, 1), two(file, 2);
  const Result with_one = solve_design(one, {}), with_two = solve_design(two, {});
  EXPECT_EQ(with_one.status, Status::verified) << with_one.message;
  EXPECT_EQ(with_two.status, Status::verified) << with_two.message;
  EXPECT_EQ(with_one.x, with_two.x);
  EXPECT_EQ(with_one.evaluation.constraints, with_two.evaluation.constraints);
  EXPECT_EQ(with_one.evaluations, with_two.evaluations);
}

TEST(LoadCases, GoOnFromTheirRecordWithTheSameDigits) {
  const ProblemFile file = problem_of(test::loaded_crank());
  EvaluationMemory memory;
  DesignProblem first(file, 1, &memory);
  const Result before = solve_design(first, {});
  const int made = memory.made;
  EXPECT_EQ(memory.known, 0);
  DesignProblem again(file, 1, &memory);
  const Result after = solve_design(again, {});
  EXPECT_EQ(memory.made, made);  // nothing is simulated a second time for an evaluation
  EXPECT_EQ(after.x, before.x);
  EXPECT_EQ(after.evaluation.objective, before.evaluation.objective);
}

TEST(LoadCases, HaveStepsOfTheirOwnWhereAnAccuracyIsAskedFor) {
  Json document = test::loaded_crank();
  document["simulation"].erase("resolution_check");
  document["accuracy"] = {{"target", "1 %"}};
  document["cases"]["heavy"]["/simulation/end_time"] = "120 ms";
  const ProblemFile file = problem_of(document);
  const StagedSolution solution = solve_in_stages(file, start_design(file), {}, {});
  EXPECT_EQ(solution.result.status, Status::verified) << solution.result.message;
  ASSERT_EQ(solution.stages.back().settings.size(), 2u);
  const ProblemFile& solved = solution.problem->file();
  EXPECT_DOUBLE_EQ(solved.cases[0].simulation.step, solution.stages.back().settings[0].step);
  EXPECT_DOUBLE_EQ(solved.cases[1].simulation.step, solution.stages.back().settings[1].step);
}

}  // namespace
}  // namespace pleuel::test::load_case_test
