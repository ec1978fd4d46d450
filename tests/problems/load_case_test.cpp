#include <nlohmann/json.hpp>

#include "core/base/eager_matrices.hpp"
#include "core/jobs/parallel.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/problem_reader.hpp"
#include "optimization/design/design_solve.hpp"
#include "optimization/design/peak_problem.hpp"
#include "optimization/design/staged_solve.hpp"
#include "tests/problems/loaded_crank.hpp"
#include "tests/support/evaluation_memory.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::load_case_test {
namespace {

// Load cases: closed forms of numbers over cases, and a mechanism against two copies of it.

using Json = nlohmann::ordered_json;

ProblemFile problem_of(const Json& document) {
  return problem_from(document.dump());
}

/// A stone on the floor and a number x whose distance from a target is squared: the target is that
/// of the case.
Json distances() {
  return Json::parse(R"json({
    "constants": {"target": 1},
    "scene": {"bodies": {"stone": {"type": "rigid", "at": [0, 0, 0], "mass": 1, "inertia": [1, 1, 1, 0, 0, 0]}},
              "joints": {"floor": {"type": "fixed", "bodies": ["ground", "stone"], "at": [0, 0, 0]}}},
    "simulation": {"end_time": "2 s", "step": "1 s"},
    "variables": {"x": {"start": 2.7, "lower": -10, "upper": 10}},
    "responses": {"distance": {"type": "expression", "value": "(x - target)^2"}},
    "objective": {"minimize": "distance", "over_cases": "worst"},
    "constraints": {},
    "cases": {"near": {}, "far": {"/constants/target": 3}, "middle": {"/constants/target": 2}}
  })json");
}

TEST(LoadCases, MeetHalfWayWhereTheWorstIsMinimized) {
  const Result result = verified_optimum(problem_of(distances()));
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
  const Result result = verified_optimum(problem_of(document));
  EXPECT_NEAR(result.x(0), 1.5, 1e-4);                  // 6 (x − 1) + 2 (x − 3) = 0
  EXPECT_NEAR(result.evaluation.objective, 3.0, 1e-4);  // 3 · 0.5² + 1.5²
}

TEST(LoadCases, HaveTheSmallestNumberAsTheWorstOfWhatIsMaximized) {
  Json document = distances();
  document["responses"]["distance"]["value"] = "-(x - target)^2";
  document["objective"] = {{"maximize", "distance"}, {"over_cases", "worst"}};
  const Result result = verified_optimum(problem_of(document));
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
  const Result one = verified_optimum(problem_of(test::loaded_crank()));
  const Result other = verified_optimum(problem_of(twins()));
  // Optima are found to 1e-6 of the objective.
  EXPECT_NEAR(one.evaluation.objective, other.evaluation.objective,
              1e-5 * other.evaluation.objective);
  EXPECT_NEAR(one.x(0), other.x(0), 1e-3 * other.x(0));
  EXPECT_NEAR(one.x(1), other.x(1), 1e-3 * other.x(1));
}

TEST(LoadCases, OfTheShippedProblemDecideALimitEach) {
  DesignProblem design(sample_problem("two_loads"));
  const Result result = verified(solve_design(design, {}));
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
  const Result with_one = verified(solve_design(one, {}));
  const Result with_two = verified(solve_design(two, {}));
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
  const StagedSolution solution = solve_in_stages(file, start_design(file), {});
  EXPECT_EQ(solution.result.status, Status::verified) << solution.result.message;
  ASSERT_EQ(solution.stages.back().settings.size(), 2u);
  const ProblemFile& solved = solution.problem->file();
  EXPECT_DOUBLE_EQ(solved.cases[0].simulation.step, solution.stages.back().settings[0].step);
  EXPECT_DOUBLE_EQ(solved.cases[1].simulation.step, solution.stages.back().settings[1].step);
}

// Expressions that name load cases, `bow[fast] - bow[slow]`: closed forms, differences, and the
// same problem said in another way.

/// A stone on the floor: what is simulated does not matter.
Json stone() {
  return Json::parse(R"json({
    "scene": {"bodies": {"stone": {"type": "rigid", "at": [0, 0, 0], "mass": 1, "inertia": [1, 1, 1, 0, 0, 0]}},
              "joints": {"floor": {"type": "fixed", "bodies": ["ground", "stone"], "at": [0, 0, 0]}}},
    "simulation": {"end_time": "2 s", "step": "1 s", "resolution_check": false}
  })json");
}

/// A number x whose distance from a target is squared: the target is that of the case.
Json two_distances() {
  Json document = stone();
  document.update(Json::parse(R"json({
    "constants": {"target": 1},
    "variables": {"x": {"start": 2.7, "lower": -10, "upper": 10}},
    "responses": {"distance": {"type": "expression", "value": "(x - target)^2"}},
    "objective": {"minimize": "= 3*distance[near] + distance[far]"},
    "cases": {"near": {}, "far": {"/constants/target": 3}}
  })json"));
  return document;
}

TEST(AcrossCases, MinimizeAFormulaOfResponsesInCases) {
  const Result result = verified_optimum(problem_of(two_distances()));
  EXPECT_NEAR(result.x(0), 1.5, 1e-4);                  // 6 (x − 1) + 2 (x − 3) = 0
  EXPECT_NEAR(result.evaluation.objective, 3.0, 1e-6);  // 3 · 0.5² + 1.5²
}

TEST(AcrossCases, TakeConstantsOfTheirCasesAndDesignVariables) {
  Json document = two_distances();
  document["responses"]["pull"] = {{"type", "expression"},
                                   {"value", "(target[far] - target[near])*x"}};
  document["objective"]["minimize"] = "= distance[near] - pull";
  const Result result = verified_optimum(problem_of(document));
  EXPECT_NEAR(result.x(0), 2.0, 1e-4);  // 2 (x − 1) − 2 = 0
}

TEST(AcrossCases, AreMaximizedWithTheirSign) {
  Json document = two_distances();
  document["objective"] = {{"maximize", "= -3*distance[near] - distance[far]"}};
  const Result result = verified_optimum(problem_of(document));
  EXPECT_NEAR(result.x(0), 1.5, 1e-4);
  EXPECT_NEAR(result.evaluation.objective, 3.0, 1e-6);  // of what is minimized: the negative
}

TEST(AcrossCases, MeetHalfWayInTheLargestOfTwo) {
  Json document = two_distances();
  document["objective"] = {{"minimize", "= max(distance[near], distance[far])"}};
  const Result result = verified_optimum(problem_of(document));
  EXPECT_NEAR(result.x(0), 2.0, 1e-4);  // (x − 1)² = (x − 3)²
  EXPECT_NEAR(result.evaluation.objective, 1.0, 1e-4);
}

TEST(AcrossCases, AreLimitedWithAPrice) {
  Json document = two_distances();
  document["objective"] = {{"minimize", "distance[far]"}};
  // (x − 1)² − (x − 3)² = 4 x − 8
  document["constraints"]["lead"] = {{"response", "= distance[near] - distance[far]"},
                                     {"upper", -2}};
  const Result result = verified_optimum(problem_of(document));
  EXPECT_NEAR(result.x(0), 1.5, 1e-6);
  EXPECT_NEAR(result.evaluation.constraints(0), -2.0, 1e-6);
  EXPECT_NEAR(result.constraint_multipliers(0), 0.75, 1e-4);  // 2 (3 − 1.5) = 4 μ
}

TEST(AcrossCases, KeepTheirMargins) {
  Json document = two_distances();
  document["objective"] = {{"minimize", "distance[far]"}};
  document["constraints"]["lead"] = {
      {"response", "= distance[near] - distance[far]"}, {"upper", -2}, {"deviations", 3}};
  document["uncertainty"] = {{"parameters", {{"x", {{"deviation", 0.1}}}}}};
  const Result result = verified_optimum(problem_of(document));
  EXPECT_NEAR(result.x(0), 1.2, 1e-5);  // 4 x − 8 + 3 · 4 · 0.1 = −2
}

/// Hock & Schittkowski 1981, problem 71: both terms of the objective and both limits are numbers of
/// two cases.
Json hock_schittkowski_71() {
  Json document = stone();
  document.update(Json::parse(R"json({
    "constants": {"a": 1, "b": 0},
    "variables": {"x1": {"start": 1, "lower": 1, "upper": 5},
                  "x2": {"start": 5, "lower": 1, "upper": 5},
                  "x3": {"start": 5, "lower": 1, "upper": 5},
                  "x4": {"start": 1, "lower": 1, "upper": 5}},
    "responses": {
      "term": {"type": "expression", "value": "a*x1*x4*(x1 + x2 + x3) + b*x3"},
      "size": {"type": "expression", "value": "a*x1*x2*x3*x4 + b*(x1^2 + x2^2 + x3^2 + x4^2)"},
      "sum": {"type": "expression", "value": "term[first] + term[second]"}
    },
    "objective": {"minimize": "sum"},
    "constraints": {"product": {"response": "size[first]", "lower": 25},
                    "sphere": {"response": "= 2*size[second]/2", "lower": 40, "upper": 40}},
    "cases": {"first": {}, "second": {"/constants/a": 0, "/constants/b": 1}}
  })json"));
  return document;
}

TEST(AcrossCases, SolveAHockSchittkowskiProblemThatIsSpreadOverCases) {
  const Result result = verified_optimum(problem_of(hock_schittkowski_71()));
  EXPECT_NEAR(result.evaluation.objective, 17.0140173, 1e-5);  // Hock & Schittkowski 1981
  const double optimum[] = {1.0, 4.7429994, 3.8211503, 1.3794082};
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(result.x(i), optimum[i], 1e-4);
}

/// A cantilever in equilibrium under a force at its tip.
Json cantilever() {
  return Json::parse(R"json({
    "scene": {
      "bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": ["1 m", 0, 0], "material": "steel",
                         "section": {"type": "rectangle", "width": "20 mm", "height": {"variable": "height"}},
                         "elements": 2}},
      "joints": {"wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}},
      "loads": {"pull": {"type": "force", "body": "bar", "at": ["1 m", 0, 0],
                         "direction": [0, 1, 0], "value": "20 N"}}},
    "effects": {"geometric_stiffening": "off"},
    "simulation": {"end_time": "2 ms", "step": "1 ms", "initial_state": "quasi-static"},
    "variables": {"height": {"start": "40 mm", "lower": "10 mm", "upper": "80 mm"}},
    "responses": {"mass": {"type": "mass"},
                  "tip": {"type": "deflection", "body": "bar", "at": 1, "over_time": "final"},
                  "spread": {"type": "expression", "value": "tip[strong] - tip[weak]"}},
    "objective": {"minimize": "mass"},
    "constraints": {"evenness": {"response": "spread", "upper": "1 mm"}},
    "cases": {"weak": {}, "strong": {"/scene/loads/pull/value": "100 N"}}
  })json");
}

/// (F₂ − F₁) L³/(3 E I) = 1 mm with I = b h³/12.
double height_of_cantilever() {
  return std::cbrt(12.0 * 80.0 / (3.0 * 210e9 * 0.020 * 1e-3));
}

TEST(AcrossCases, LimitTheDifferenceOfTwoDeflectionsOfACantilever) {
  DesignProblem design(problem_of(cantilever()));
  const Result result = verified(solve_design(design, {}));
  EXPECT_NEAR(result.x(0), height_of_cantilever(), 1e-6 * height_of_cantilever());
  ASSERT_FALSE(result.response_errors.empty());
  const ProblemFile& file = design.file();
  const std::size_t spread = design.response_index("spread");
  ASSERT_TRUE(is_over_cases(file, spread));
  ASSERT_TRUE(result.response_errors[spread]);
  const auto& weak = result.response_errors[design.response_index("tip [weak]")];
  const auto& strong = result.response_errors[design.response_index("tip [strong]")];
  // Errors of both cases are their own: the bound of the difference is the sum of the bounds.
  EXPECT_NEAR(result.response_errors[spread]->bound(), weak->bound() + strong->bound(),
              1e-3 * (weak->bound() + strong->bound()) + 1e-12);
}

/// Bent upwards by F and sideways by half of it, with v = 2 w: F L³/(3 E b h³/12) = F L³/(3 E h b³/12),
/// so that b = h, and w = 1 mm. The difference is zero to the last digit, and its error is small
/// beside what it is the difference of.
TEST(AcrossCases, MayBeHeldAtZero) {
  const ProblemFile problem = problem_of(Json::parse(R"json({
    "scene": {"gravity": [0, 0, 0],
      "bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": [0.4, 0, 0], "material": "steel",
                         "section": {"type": "rectangle", "width": {"variable": "b"}, "height": {"variable": "h"}},
                         "elements": 4}},
      "joints": {"wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}},
      "loads": {"push": {"type": "force", "body": "bar", "at": [0.4, 0, 0],
                         "direction": [0, -1, 0], "value": "1 kN"}}},
    "simulation": {"end_time": "10 ms", "step": "1 ms", "initial_state": "quasi-static"},
    "variables": {"b": {"start": "20 mm", "lower": "5 mm", "upper": "60 mm"},
                  "h": {"start": "20 mm", "lower": "5 mm", "upper": "60 mm"}},
    "responses": {"mass": {"type": "mass"},
                  "sag": {"type": "deflection", "body": "bar", "at": 1, "direction": "resultant",
                          "over_time": "max"}},
    "objective": {"minimize": "mass"},
    "constraints": {"stiffness": {"response": "sag", "upper": "1 mm", "cases": ["side"]},
      "proportion": {"response": "= sag[down] - 2*sag[side]", "lower": 0, "upper": 0}},
    "cases": {"down": {}, "side": {"/scene/loads/push/direction": [0, 0, 1], "/scene/loads/push/value": "0.5 kN"}}
  })json"));
  const Result result = verified_optimum(problem);
  const double size = std::pow(12.0 * 500.0 * std::pow(0.4, 3) / (3.0 * 210e9 * 1e-3), 0.25);
  EXPECT_NEAR(result.x(0), size, 1e-4 * size);
  EXPECT_NEAR(result.x(1), size, 1e-4 * size);
}

/// A turn of a slender crank with a load at its end, at two speeds and with two loads.
Json crank() {
  Json document = test::loaded_crank();
  document["responses"]["tip"]["over_time"] = "rms";
  document["responses"]["ratio"] = {{"type", "expression"},
                                    {"value", "tip[fast]/tip[heavy] + (1 mm)/width"}};
  document["objective"] = {{"minimize", "= tip[fast]*ratio + 0.2*tip[heavy]"}};
  document["constraints"] = Json::parse(R"json({
      "balance": {"response": "= tip[fast] - tip[heavy]", "upper": "1 mm"},
      "evenness": {"response": "ratio", "lower": 0.1},
      "strength": {"response": "stress", "upper": "60 MPa"},
      "weight": {"response": "mass", "upper": "0.5 kg"}
    })json");
  return document;
}

Evaluation evaluated(const Json& document) {
  const ProblemFile file = problem_of(document);
  DesignProblem design(file);
  return design.evaluate(start_design(file), Request::values_and_gradients);
}

TEST(AcrossCases, HaveTheGradientsOfTheChainRule) {
  const ProblemFile file = problem_of(crank());
  DesignProblem design(file);
  const Eigen::VectorXd x = start_design(file);
  const Evaluation exact = design.evaluate(x, Request::values_and_gradients);
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    // Central differences: error ~ h² and 1e-12/h of the values; 1e-6 is ten times what was seen.
    const double h = 1e-5 * x(j);
    Eigen::VectorXd above = x, below = x;
    above(j) += h;
    below(j) -= h;
    const Evaluation up = design.evaluate(above, Request::values);
    const Evaluation down = design.evaluate(below, Request::values);
    const double slope = (up.objective - down.objective) / (2.0 * h);
    EXPECT_NEAR(exact.objective_gradient(j), slope, 1e-6 * exact.objective_gradient.norm());
    const Eigen::VectorXd slopes = (up.constraints - down.constraints) / (2.0 * h);
    for (Eigen::Index i = 0; i < slopes.size(); ++i) {
      EXPECT_NEAR(exact.constraint_jacobian(i, j), slopes(i),
                  1e-6 * exact.constraint_jacobian.row(i).norm())
          << design.constraints()[i].name;
    }
  }
}

TEST(AcrossCases, HaveTheSameGradientsByTheAdjoint) {
  Json document = crank();
  const Evaluation direct = evaluated(document);
  document["sensitivity"]["method"] = "adjoint";
  const Evaluation adjoint = evaluated(document);
  EXPECT_NEAR((direct.objective_gradient - adjoint.objective_gradient).norm(), 0.0,
              1e-10 * direct.objective_gradient.norm());
  EXPECT_NEAR((direct.constraint_jacobian - adjoint.constraint_jacobian).norm(), 0.0,
              1e-10 * direct.constraint_jacobian.norm());
}

TEST(AcrossCases, AreMadeOfTheNumbersOfTheCases) {
  const ProblemFile file = problem_of(crank());
  DesignProblem design(file);
  const Eigen::VectorXd x = start_design(file);
  const Evaluation all = design.evaluate(x, Request::values);
  const auto tip = [&](const std::string& name) {
    const ProblemFile one = problem_of_case(file, name);
    return analyze(one, x)->reductions[2].value;
  };
  ASSERT_EQ(file.cases[0].responses[2].name, "tip");
  const double fast = tip("fast"), heavy = tip("heavy");
  const double ratio = fast / heavy + 1e-3 / x(0);
  EXPECT_DOUBLE_EQ(all.objective, fast * ratio + 0.2 * heavy);
}

/// With limits that decide: the optimum is not at a bound.
Json stiff_crank() {
  Json document = crank();
  document["objective"] = {{"minimize", "mass"}};
  document["responses"]["most"] = {{"type", "expression"},
                                   {"value", "max(stress[fast], stress[heavy])"}};
  document["constraints"] = Json::parse(R"json({
      "strength": {"response": "most", "upper": "60 MPa"},
      "sag": {"response": "= tip[fast] + tip[heavy]", "upper": "0.15 mm"},
      "shape": {"linear": {"height": 1, "width": -2}, "upper": 0}})json");
  return document;
}

TEST(AcrossCases, LimitTheLargestOfTwoAsBothDo) {
  Json document = stiff_crank();
  document["constraints"].erase("sag");
  DesignProblem largest(problem_of(document));
  document["constraints"]["strength"]["response"] = "stress";
  DesignProblem both(problem_of(document));
  const Result one = verified(solve_design(largest, {}));
  const Result other = verified(solve_design(both, {}));
  // Optima are found to 1e-6 of the objective.
  EXPECT_NEAR(one.evaluation.objective, other.evaluation.objective,
              1e-5 * other.evaluation.objective);
}

TEST(AcrossCases, HaveTheSameDigitsWhateverTheNumberOfJobs) {
  const ProblemFile file = problem_of(stiff_crank());
  DesignProblem one(file, 1), two(file, 2);
  const Result with_one = verified(solve_design(one, {})), with_two = solve_design(two, {});
  EXPECT_EQ(with_one.x, with_two.x);
  EXPECT_EQ(with_one.evaluation.constraints, with_two.evaluation.constraints);
  EXPECT_EQ(with_one.constraint_multipliers, with_two.constraint_multipliers);
  EXPECT_EQ(with_one.evaluations, with_two.evaluations);
}

}  // namespace
}  // namespace pleuel::test::load_case_test
