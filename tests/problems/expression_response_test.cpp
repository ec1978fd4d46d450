#include <nlohmann/json.hpp>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/linearized_expression.hpp"
#include "core/trust/checks.hpp"
#include "optimization/design/design_solve.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/problems/verified_optimum.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

/// A slider-crank whose points are formulas of the lengths of crank and rod: its stroke is twice the
/// crank, whatever the rod.
namespace pleuel::test::expression_response_test {
namespace {

using Json = nlohmann::ordered_json;

Json slider_crank() {
  return Json::parse(R"json({
    "constants": {"speed": "10 rad/s"},
    "scene": {
      "bodies": {
        "crank": {"type": "beam", "from": [0, 0, 0], "to": ["= crank", 0, 0], "rigid": true,
                  "material": "steel", "section": {"type": "circle", "diameter": "= crank/5"},
                  "elements": 1},
        "rod": {"type": "beam", "from": ["= crank", 0, 0], "to": ["= crank + rod", 0, 0],
                "rigid": true, "material": "steel",
                "section": {"type": "circle", "diameter": "8 mm"}, "elements": 1},
        "slider": {"type": "point-mass", "at": ["= crank + rod", 0, 0], "mass": "0.2 kg"}
      },
      "joints": {
        "bearing": {"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0],
                    "drive": {"type": "constant-speed", "speed": "= speed"}},
        "pin": {"type": "revolute", "bodies": ["crank", "rod"], "at": ["= crank", 0, 0]},
        "end": {"type": "revolute", "bodies": ["rod", "slider"], "at": ["= crank + rod", 0, 0]},
        "guide": {"type": "point-on-line", "bodies": ["ground", "slider"],
                  "at": ["= crank + rod", 0, 0], "axis": [1, 0, 0]}
      }
    },
    "simulation": {"end_time": "= 7 rad/speed", "step": "5 ms"},
    "variables": {
      "crank": {"start": "40 mm", "lower": "20 mm", "upper": "80 mm"},
      "rod": {"start": "150 mm", "lower": "120 mm", "upper": "200 mm"}
    },
    "responses": {
      "stroke": {"type": "expression", "value": "right - left"},
      "left": {"type": "position", "body": "slider", "direction": "x", "over_time": "min"},
      "right": {"type": "position", "body": "slider", "direction": "x", "over_time": "max"},
      "mass": {"type": "mass"},
      "effort": {"type": "drive-torque", "joint": "bearing", "over_time": "rms"},
      "cost": {"type": "expression",
               "value": "sqrt(effort^2 + (1 N m)^2)*mass/(1 kg)/(stroke + rod) + 3 N*max(0.1, crank/rod)"
}
}
  })json");
}

ProblemFile problem_of(const Json& document) {
  return problem_from(document.dump());
}

double value_of(const ProblemFile& problem, const Analysis& analysis, const char* name) {
  return analysis.reductions[response_index(problem, name)].value;
}

TEST(ExpressionOfResponses, IsTheStrokeOfASliderCrank) {
  const ProblemFile problem = problem_of(slider_crank());
  Eigen::VectorXd x(2);
  for (const double crank : {0.04, 0.055}) {
    x << crank, 0.15;
    const auto analysis = analyze(problem, x);
    // The peak between two steps of 0.05 rad is that of a parabola: 0.05⁴ off.
    EXPECT_NEAR(value_of(problem, *analysis, "stroke"), 2 * crank, 1e-5 * crank);
  }
}

TEST(ExpressionOfResponses, HasTheGradientOfTheStroke) {
  const ProblemFile problem = problem_of(slider_crank());
  const auto analysis = analyze(problem, start_design(problem));
  const Eigen::MatrixXd gradients = direct_gradients(*analysis);
  const Eigen::Index stroke = response_index(problem, "stroke");
  EXPECT_NEAR(gradients(stroke, 0), 2.0, 1e-5);
  EXPECT_NEAR(gradients(stroke, 1), 0.0, 1e-5);
}

TEST(ExpressionOfResponses, HasOneGradientByAllMethods) {
  const ProblemFile problem = problem_of(slider_crank());
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const Eigen::Index cost = response_index(problem, "cost");
  const auto by = [&](GradientMethod method) -> Eigen::RowVectorXd {
    return gradients(problem, x, *analysis, method).row(cost);
  };
  const Eigen::RowVectorXd direct = by(GradientMethod::direct);
  EXPECT_LT((by(GradientMethod::adjoint) - direct).norm(), 1e-10 * direct.norm());
  // Differences with a relative step of 1e-5 have the noise of Newton's method over it.
  EXPECT_LT((by(GradientMethod::central_difference) - direct).norm(), 1e-5 * direct.norm());
}

/// The chain rule by hand, from the gradients of the parts.
TEST(ExpressionOfResponses, FollowsTheChainRuleThroughOtherExpressions) {
  Json document = slider_crank();
  document["responses"]["twice"] = {{"type", "expression"}, {"value", "2*stroke*mass - rod*mass"}};
  const ProblemFile problem = problem_of(document);
  const auto analysis = analyze(problem, start_design(problem));
  const Eigen::MatrixXd g = direct_gradients(*analysis);
  const auto row = [&](const char* name) -> Eigen::RowVectorXd {
    return g.row(response_index(problem, name));
  };
  const double mass = value_of(problem, *analysis, "mass"),
               stroke = value_of(problem, *analysis, "stroke");
  Eigen::RowVectorXd expected =
      2 * mass * (row("right") - row("left")) + (2 * stroke - 0.15) * row("mass");
  expected(1) -= mass;  // explicitly by the rod
  EXPECT_LT((row("twice") - expected).norm(), 1e-12 * expected.norm());
}

/// To first order the error of a difference is at most the sum of those of both.
TEST(ExpressionOfResponses, HasAnErrorBarFromItsParts) {
  Json document = slider_crank();
  document["responses"]["sum"] = {{"type", "expression"}, {"value", "3*effort + 2 N*right"}};
  const ProblemFile problem = problem_of(document);
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const Monitors monitors = monitor(analysis->model, analysis->trajectory);
  const Trust trust = judge_run({problem, x, *analysis, monitors});
  const auto bar = [&](const char* name) { return *trust.errors[response_index(problem, name)]; };
  EXPECT_TRUE(bar("sum").is_resolved());
  EXPECT_GT(bar("sum").bound(), 0.0);
  EXPECT_LE(bar("sum").bound(), 3 * bar("effort").bound() + 2 * bar("right").bound() + 1e-12);
  EXPECT_GE(bar("sum").bound(), 0.5 * 3 * bar("effort").bound() - 2 * bar("right").bound());
}

TEST(ExpressionOfResponses, WithoutFiniteValueSaysSo) {
  Json document = slider_crank();
  document["responses"]["root"] = {{"type", "expression"}, {"value", "sqrt(left - right)"}};
  const ProblemFile problem = problem_of(document);
  try {
    analyze(problem, start_design(problem));
    FAIL() << "nothing was said";
  } catch (const SimulationError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("the response \"root\" has no finite value there: "
                        "\"sqrt(left - right)\", with left = "),
              std::string::npos)
        << error.what();
  }
}

TEST(ExpressionOfResponses, WithoutDerivativeSaysSoWhereItIsAsked) {
  Json document = slider_crank();
  document["responses"]["root"] = {{"type", "expression"}, {"value", "sqrt(mass - mass)"}};
  const ProblemFile problem = problem_of(document);
  const auto analysis = analyze(problem, start_design(problem));  // the value is 0
  EXPECT_THROW(direct_gradients(*analysis), SimulationError);
}

/// The longest crank whose stroke is 100 mm.
TEST(Maximize, FindsTheLargestDesignWithinItsLimits) {
  Json document = slider_crank();
  document["objective"] = {{"maximize", "= crank"}};
  document["constraints"]["room"] = {{"response", "stroke"}, {"upper", "100 mm"}};
  const Result result = verified_optimum(problem_of(document));
  EXPECT_NEAR(result.x(0), 0.05, 1e-6);
  EXPECT_NEAR(-result.evaluation.objective, 0.05, 1e-6);
}

TEST(Maximize, IsToMinimizeTheNegative) {
  Json document = slider_crank();
  document["objective"] = {{"maximize", "= cost/(1 N)"}};
  const ProblemFile largest = problem_of(document);
  document["objective"] = {{"minimize", "= -cost/(1 N)"}};
  const ProblemFile smallest = problem_of(document);
  DesignProblem a(largest), b(smallest);
  const Eigen::VectorXd x = start_design(largest);
  const Evaluation of_a = a.evaluate(x, Request::values_and_gradients),
                   of_b = b.evaluate(x, Request::values_and_gradients);
  EXPECT_EQ(of_a.objective, of_b.objective);
  EXPECT_LT((of_a.objective_gradient - of_b.objective_gradient).norm(),
            1e-12 * of_b.objective_gradient.norm());
}

}  // namespace
}  // namespace pleuel::test::expression_response_test
