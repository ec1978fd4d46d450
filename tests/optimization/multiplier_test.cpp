#include <random>

#include "core/base/eager_matrices.hpp"
#include "optimization/backends.hpp"
#include "optimization/kkt_audit.hpp"
#include "optimization/result.hpp"
#include "optimization/solve.hpp"
#include "tests/optimization/known_problems.hpp"
#include "tests/support/test.hpp"

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

TEST_P(Multipliers, AreThosePublished) {
  const Result hs35 = solve_tightly(hs035().problem), hs43 = solve_tightly(hs043().problem);
  EXPECT_NEAR(hs35.constraint_multipliers[0], 2.0 / 9.0, tolerance);
  EXPECT_NEAR(hs43.constraint_multipliers[0], 1.0, tolerance);
  EXPECT_NEAR(hs43.constraint_multipliers[1], 0.0, tolerance);
  EXPECT_NEAR(hs43.constraint_multipliers[2], 2.0, 2.0 * tolerance);
}

// f*(d) = f*(1) d^{−1/3}, hence λ = −df*/dd = f*(d) / (3 d): exact as long as no bound is active,
// that is, for all three limits.
TEST_P(Multipliers, OfTheCantileverIsTheSlopeOfTheOptimumOverTheLimit) {
  for (const double limit : {0.7, 1.0, 1.8}) {
    const KnownProblem known = cantilever(limit);
    const Result result = verified(solve_tightly(known.problem));
    EXPECT_NEAR(result.evaluation.objective, known.optimum, 1e-5 * known.optimum);
    const double price = known.optimum / (3.0 * limit);
    EXPECT_NEAR(result.constraint_multipliers[0], price, tolerance * price);
  }
}

// min (a − 3)² + (b + 2)², 0 ≤ a, b ≤ 1: at (1, 0) the slopes are −4 and 4, against upper and
// lower.
TEST_P(Multipliers, OfBoundsBalanceTheSlopeOfTheObjective) {
  const Result result = verified(solve_tightly(
      by_formulas({{"a", 0.5, 0.0, 1.0}, {"b", 0.5, 0.0, 1.0}}, {}, [](const auto& x) {
        return responses((x[0] - 3.0) * (x[0] - 3.0) + (x[1] + 2.0) * (x[1] + 2.0));
      })));
  EXPECT_NEAR(result.bound_multipliers[0], 4.0, tolerance);
  EXPECT_NEAR(result.bound_multipliers[1], -4.0, tolerance);
}

// Fixing the first width of the cantilever away from its optimum leaves four variables, for which
// the stationarity of the Lagrangian gives f* = 0.0624 (x₁ + S^{4/3} (1 − 61/x₁³)^{−1/3}) with S =
// Σ_{i>1} aᵢ^{1/4}.
TEST_P(Multipliers, AFixedVariableStaysAndHasAPrice) {
  const double width = 6.5;
  const FunctionProblem problem = with_each_variable(cantilever().problem, [&](Variable& variable) {
    if (variable.name == "x1") variable = {"x1", width, width, width};
  });
  const auto optimum = [](double x) {
    const double sum = std::pow(37.0, 0.25) + std::pow(19.0, 0.25) + std::pow(7.0, 0.25) + 1.0;
    return 0.0624 * (x + std::pow(sum, 4.0 / 3.0) / std::cbrt(1.0 - 61.0 / (x * x * x)));
  };
  const Result result = verified(solve_tightly(problem));
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
    for (double* size : {&variable.start, &variable.lower, &variable.upper}) *size *= millimetre;
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
  const Result result = verified(solve_tightly(problem));
  EXPECT_NEAR(result.constraint_multipliers[0] * micrometre / gram, known.optimum / 3.0,
              tolerance * known.optimum);
}

/// xᵢ = aᵢ^{1/4} S^{1/3}.
Eigen::VectorXd optimum_of_cantilever() {
  const Eigen::VectorXd roots = Vector<double>{{61.0, 37.0, 19.0, 7.0, 1.0}}.array().sqrt().sqrt();
  return roots * std::cbrt(roots.sum());
}

/// The same deflection limited twice: the limit with 4 % slack holds nothing, though its gradient
/// explains the optimum as well as that of the other one.
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
  const Verdict verdict = judge_anew(problem, optimum_of_cantilever());
  EXPECT_EQ(verdict.status, Status::verified) << verdict.message;
  EXPECT_NEAR(verdict.audit.constraint_multipliers[0], 0.0, 1e-9);
  EXPECT_NEAR(verdict.audit.constraint_multipliers[1], known.optimum / 3.0, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Backends, Multipliers, testing::ValuesIn(optimizer_names()),
                         name_of_backend);

Eigen::MatrixXd random_matrix(std::mt19937& engine, Eigen::Index rows, Eigen::Index columns) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&]() { return uniform(engine); });
}

// A z ≥ 0 is the solution if and only if the slope Aᵀ(A z − b) is ≥ 0, and 0 where z > 0 (Lawson &
// Hanson 1974, theorem 23.4). Rounding: 1e-12 for numbers of order one.
void expect_solution(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  const Eigen::VectorXd z = nonnegative_least_squares(matrix, right);
  const Eigen::VectorXd slope = matrix.transpose() * (matrix * z - right);
  EXPECT_GE(z.minCoeff(), 0.0);
  EXPECT_GE(slope.minCoeff(), -1e-12 * matrix.norm() * right.norm());
  EXPECT_NEAR(slope.dot(z), 0.0, 1e-12 * matrix.norm() * right.norm() * (1.0 + z.norm()));
}

TEST(NonnegativeLeastSquares, SatisfiesItsConditionsOnRandomMatrices) {
  std::mt19937 engine(1);
  for (int sample = 0; sample < 200; ++sample) {
    const Eigen::Index rows = 1 + sample % 7, columns = 1 + sample % 11;
    expect_solution(random_matrix(engine, rows, columns), random_matrix(engine, rows, 1));
    // Dependent columns, and one of zeros.
    Eigen::MatrixXd matrix = random_matrix(engine, 4, 6);
    matrix.col(1) = 3.0 * matrix.col(0);
    matrix.col(2) = -matrix.col(0);
    matrix.col(3).setZero();
    expect_solution(matrix, random_matrix(engine, 4, 1));
  }
  EXPECT_EQ(nonnegative_least_squares(Eigen::MatrixXd(3, 0), Eigen::Vector3d::Ones()).size(), 0);
}

TEST(NonnegativeLeastSquares, DoesNotDependOnTheLengthOfColumns) {
  std::mt19937 engine(3);
  const Eigen::MatrixXd matrix = random_matrix(engine, 5, 3).cwiseAbs();
  const Eigen::VectorXd right = matrix * Eigen::Vector3d(1.0, 0.0, 2.0);
  const Eigen::Vector3d lengths(1e9, 1.0, 1e-9);
  const Eigen::VectorXd z = nonnegative_least_squares(matrix * lengths.asDiagonal(), right);
  EXPECT_TRUE(z.cwiseProduct(lengths).isApprox(Eigen::Vector3d(1.0, 0.0, 2.0), 1e-12));
}

/// Limits that need no function: c between 0 and 1, below 10, above 2.
FunctionProblem limits() {
  return FunctionProblem({{"x", 1.0, 0.0, 5.0}},
                         {{"both", 0.0, 1.0}, {"below", -infinity, 10.0}, {"above", 2.0, infinity}},
                         {});
}

TEST(Prices, AreThoseOfLimitsThatAreReached) {
  struct Case {
    const char* what;
    Eigen::Vector3d values, multipliers, expected;
  };
  const Eigen::Vector3d scales(1.0, 10.0, 2.0), all(0.5, 0.3, -0.2), none(0.0, 0.0, 0.0);
  for (const Case& of :
       {Case{"1e-4, violated, exact", {0.9999, 10.0005, 2.0}, all, all},
        Case{"1 % of the magnitude", {0.99, 9.9, 2.02}, all, none},
        Case{"less than a thousandth", {1 - 0.9e-3, 10 - 0.9e-2, 2 + 1.8e-3}, all, all},
        Case{"more than a thousandth", {1 - 1.1e-3, 10 - 1.1e-2, 2 + 2.2e-3}, all, none},
        Case{"the lower of two", {1e-4, 9.9, 2.02}, {-0.5, 0.3, -0.2}, {-0.5, 0.0, 0.0}}}) {
    EXPECT_EQ(prices_of(limits(), of.values, of.multipliers, scales), of.expected) << of.what;
  }
}

TEST(Prices, AreThoseOfOptimaOnly) {
  Result result;
  result.evaluation.objective_gradient = Eigen::VectorXd::Ones(1);
  for (const auto& [status, residual, expected] :
       std::vector<std::tuple<Status, double, bool>>{{Status::verified, 1e-6, true},
                                                     {Status::unresolved, 1e-6, true},
                                                     {Status::stalled, 0.9e-2, true},
                                                     {Status::stalled, 1.1e-2, false},
                                                     {Status::infeasible, 1e-6, false},
                                                     {Status::failed, 1e-6, false},
                                                     {Status::interrupted, 1e-6, false}}) {
    result.status = status;
    result.kkt_residual = residual;
    EXPECT_EQ(has_prices(result), expected) << int(status) << " with " << residual;
  }
}

/// f*(d) = f*(1) d^{−1/3}: the price is f/3 to first order in the violation, here 3e-5.
TEST(Prices, OfALimitThatIsSlightlyViolatedAreThoseOfTheLimit) {
  KnownProblem known = cantilever();
  const Verdict verdict = judge_anew(known.problem, optimum_of_cantilever() * (1.0 - 1e-5));
  EXPECT_GT(verdict.design.max_violation, 2e-5);
  EXPECT_NEAR(verdict.audit.constraint_multipliers[0], known.optimum / 3.0, 1e-3 * known.optimum);
}

TEST(BrokenLimits, AreNamedTheWorstFirst) {
  const FunctionProblem problem = limits();
  const Eigen::Vector3d scales(1.0, 10.0, 2.0);
  EXPECT_EQ(
      broken_limits(problem, Eigen::Vector3d(1.1, 15.0, 1.5), scales, 1e-4),
      "below = 15 exceeds its upper limit 10, above = 1.5 falls below its lower limit 2, both "
      "= 1.1 exceeds its upper limit 1");
  EXPECT_EQ(broken_limits(problem, Eigen::Vector3d(0.5, 10.0005, 2.5), scales, 1e-4), "");
}

/// x ≤ 1 and 2x ≥ 4: no design keeps both.
TEST(InfeasibleDesign, IsTheLeastViolationThatWasSeen) {
  for (const std::string backend : {"nlopt-slsqp", "nlopt-mma", "ipopt"}) {
    FunctionProblem problem =
        by_formulas({{"x", 0.2, 0.0, 5.0}}, {{"a", -infinity, 1.0}, {"b", 4.0, infinity}},
                    [](const auto& x) { return responses(x[0] * x[0], x[0], 2.0 * x[0]); });
    const Result result = solve(problem, {.backend = backend});
    EXPECT_EQ(result.status, Status::infeasible) << backend;
    const auto least =
        std::ranges::min_element(result.history, {}, &EvaluationRecord::max_violation);
    EXPECT_EQ(result.max_violation, least->max_violation) << backend;
    EXPECT_THAT(result.message, HasSubstr("falls below its lower limit 4")) << backend;
  }
}

}  // namespace
}  // namespace pleuel::test::multiplier_test
