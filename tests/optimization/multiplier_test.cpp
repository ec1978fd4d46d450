#include <cmath>

#include <gtest/gtest.h>

#include "backend_names.hpp"
#include "complex_step.hpp"
#include "core/base/eager_matrices.hpp"
#include "known_problems.hpp"
#include "optimization/backends.hpp"
#include "optimization/solve.hpp"

namespace pleuel::test::multiplier_test {
namespace {

class Multipliers : public testing::TestWithParam<std::string> {
 protected:
  Result solve_tightly(FunctionProblem problem) const {
    return solve(problem, {.backend = GetParam(), .tolerance = 1e-8});
  }
};

// Tolerances: multipliers are as wrong as the design, ‖Δλ‖ ~ ‖∇²L‖ ‖Δx‖, and ‖Δx‖ ~ √(1e-8) for a
// backend that stops on the objective; measured at most 2e-4, times ten.
constexpr double tolerance = 2e-3;

TEST_P(Multipliers, OfHS035IsTwoNinths) {
  const Result result = solve_tightly(hs035().problem);
  EXPECT_NEAR(result.constraint_multipliers[0], 2.0 / 9.0, tolerance);
}

TEST_P(Multipliers, OfHS043AreOneZeroTwo) {
  const Result result = solve_tightly(hs043().problem);
  EXPECT_NEAR(result.constraint_multipliers[0], 1.0, tolerance);
  EXPECT_NEAR(result.constraint_multipliers[1], 0.0, tolerance);
  EXPECT_NEAR(result.constraint_multipliers[2], 2.0, 2.0 * tolerance);
}

// f*(d) = f*(1) d^{−1/3}, hence λ = −df*/dd = f*(d) / (3 d): exact as long as no bound is active,
// that is, for all three limits.
TEST_P(Multipliers, OfTheCantileverIsTheSlopeOfTheOptimumOverTheLimit) {
  for (const double limit : {0.7, 1.0, 1.8}) {
    const KnownProblem known = cantilever(limit);
    const Result result = solve_tightly(known.problem);
    EXPECT_EQ(result.status, Status::verified) << result.message;
    EXPECT_NEAR(result.evaluation.objective, known.optimum, 1e-5 * known.optimum);
    const double price = known.optimum / (3.0 * limit);
    EXPECT_NEAR(result.constraint_multipliers[0], price, tolerance * price);
  }
}

// min (a − 3)² + (b + 2)², 0 ≤ a, b ≤ 1: at (1, 0) the slopes are −4 and 4, against upper and
// lower.
TEST_P(Multipliers, OfBoundsBalanceTheSlopeOfTheObjective) {
  FunctionProblem problem({{"a", 0.5, 0.0, 1.0}, {"b", 0.5, 0.0, 1.0}}, {},
                          by_complex_step([](const auto& x) {
                            using Scalar = std::decay_t<decltype(x[0])>;
                            return Vector<Scalar>::Constant(
                                1, (x[0] - 3.0) * (x[0] - 3.0) + (x[1] + 2.0) * (x[1] + 2.0));
                          }));
  const Result result = solve_tightly(problem);
  EXPECT_EQ(result.status, Status::verified) << result.message;
  EXPECT_NEAR(result.bound_multipliers[0], 4.0, tolerance);
  EXPECT_NEAR(result.bound_multipliers[1], -4.0, tolerance);
}

// Fixing the first width of the cantilever away from its optimum leaves four variables, for which
// the stationarity of the Lagrangian gives f* = 0.0624 (x₁ + S^{4/3} (1 − 61/x₁³)^{−1/3}) with S =
// Σ_{i>1} aᵢ^{1/4}.
TEST_P(Multipliers, AFixedVariableStaysAndHasAPrice) {
  const double width = 6.5;
  KnownProblem known = cantilever();
  std::vector<Variable> variables = known.problem.variables();
  variables[0] = {"x1", width, width, width};
  FunctionProblem problem(variables, known.problem.constraints(),
                          [&](const Eigen::VectorXd& x, Request request) {
                            return known.problem.evaluate(x, request);
                          });
  const auto optimum = [](double x) {
    const double sum = std::pow(37.0, 0.25) + std::pow(19.0, 0.25) + std::pow(7.0, 0.25) + 1.0;
    return 0.0624 * (x + std::pow(sum, 4.0 / 3.0) / std::cbrt(1.0 - 61.0 / (x * x * x)));
  };
  const Result result = solve_tightly(problem);
  EXPECT_EQ(result.status, Status::verified) << result.message;
  EXPECT_EQ(result.x[0], width);
  EXPECT_NEAR(result.evaluation.objective, optimum(width), 1e-5);
  const double slope = (optimum(width + 1e-4) - optimum(width - 1e-4)) / 2e-4;
  EXPECT_NEAR(result.bound_multipliers[0], -slope, tolerance * 0.0624);
}

// The optimum of the truss lies where the price of a stress limit is measured in mass per stress:
// units scale it and nothing else.
TEST_P(Multipliers, AreGivenInTheUnitsOfTheProblem) {
  KnownProblem known = cantilever();
  const double gram = 1e3, micrometre = 1e6, millimetre = 1e3;
  std::vector<Variable> variables = known.problem.variables();
  for (Variable& variable : variables) {
    variable = {variable.name, variable.start * millimetre, variable.lower * millimetre,
                variable.upper * millimetre};
  }
  FunctionProblem problem(variables, {{"deflection", -infinity, micrometre}},
                          [&](const Eigen::VectorXd& x, Request request) {
                            Evaluation evaluation = known.problem.evaluate(x / millimetre, request);
                            evaluation.objective *= gram;
                            evaluation.constraints *= micrometre;
                            evaluation.objective_gradient *= gram / millimetre;
                            evaluation.constraint_jacobian *= micrometre / millimetre;
                            return evaluation;
                          });
  const Result result = solve_tightly(problem);
  EXPECT_EQ(result.status, Status::verified) << result.message;
  EXPECT_NEAR(result.constraint_multipliers[0] * micrometre / gram, known.optimum / 3.0,
              tolerance * known.optimum);
}

// The same deflection limited twice: the limit with 4 % slack holds nothing, though its gradient
// explains the optimum xᵢ = aᵢ^{1/4} S^{1/3} as well as that of the other one.
TEST(Multiplier, BelongsToTheLimitThatIsReached) {
  KnownProblem known = cantilever();
  FunctionProblem problem(
      known.problem.variables(), {{"loose", -infinity, 1.04}, {"tight", -infinity, 1.0}},
      [&](const Eigen::VectorXd& x, Request request) {
        Evaluation evaluation = known.problem.evaluate(x, request);
        evaluation.constraints = evaluation.constraints.replicate(2, 1).eval();
        evaluation.constraint_jacobian = evaluation.constraint_jacobian.replicate(2, 1).eval();
        return evaluation;
      });
  const Eigen::VectorXd roots = Vector<double>{{61.0, 37.0, 19.0, 7.0, 1.0}}.array().sqrt().sqrt();
  const Eigen::VectorXd optimum = roots * std::cbrt(roots.sum());
  const Verdict verdict = judge_anew(problem, checked_start(problem), optimum);
  EXPECT_EQ(verdict.status, Status::verified) << verdict.message;
  EXPECT_NEAR(verdict.audit.constraint_multipliers[0], 0.0, 1e-9);
  EXPECT_NEAR(verdict.audit.constraint_multipliers[1], known.optimum / 3.0, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Backends, Multipliers, testing::ValuesIn(optimizer_names()),
                         name_of_backend);

}  // namespace
}  // namespace pleuel::test::multiplier_test
