#include "optimization/robust_problem.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "optimization/backends.hpp"
#include "optimization/solve.hpp"
#include "tests/optimization/backend_names.hpp"

namespace pleuel::test::robust_problem_test {
namespace {

using Eigen::Vector2d;

/// minimize x + y  subject to  c₀ = x² y + sin y ≤ 3,  c₁ = x − y ≥ −10,  c₂ = y² ≤ 100
FunctionProblem curved_problem() {
  return FunctionProblem(
      {{"x", 1.5, -10.0, 10.0}, {"y", 0.7, -10.0, 10.0}},
      {{"curved", -infinity, 3.0}, {"linear", -10.0, infinity}, {"certain", -infinity, 100.0}},
      [](const Eigen::VectorXd& x, Request) {
        Evaluation evaluation;
        evaluation.objective = x.sum();
        evaluation.objective_gradient = Vector2d(1.0, 1.0);
        evaluation.constraints =
            Eigen::Vector3d(x(0) * x(0) * x(1) + std::sin(x(1)), x(0) - x(1), x(1) * x(1));
        evaluation.constraint_jacobian.resize(3, 2);
        evaluation.constraint_jacobian << 2.0 * x(0) * x(1), x(0) * x(0) + std::cos(x(1)), 1.0,
            -1.0, 0.0, 2.0 * x(1);
        return evaluation;
      });
}

constexpr double a = 0.1, b = 0.02;  // deviations of x and y

/// σ of c₀, by hand.
double deviation(double x, double y) {
  return std::hypot(a * 2.0 * x * y, b * (x * x + std::cos(y)));
}

TEST(RobustProblem, LimitsTheValueWithItsDeviations) {
  FunctionProblem problem = curved_problem();
  RobustProblem robust(problem, Vector2d(a, b), Eigen::Vector3d(2.0, 3.0, 0.0));
  const Vector2d x(1.5, 0.7);
  const Evaluation plain = problem.evaluate(x, Request::values);
  const Evaluation found = robust.evaluate(x, Request::values);
  EXPECT_FALSE(found.has_gradients());
  EXPECT_EQ(found.objective, plain.objective);
  EXPECT_NEAR(found.constraints(0), plain.constraints(0) + 2.0 * deviation(1.5, 0.7), 1e-14);
  EXPECT_NEAR(found.constraints(1), plain.constraints(1) - 3.0 * std::hypot(a, b), 1e-14);
  EXPECT_EQ(found.constraints(2), plain.constraints(2));
}

/// ∂σ/∂x and ∂σ/∂y by hand: differences of second order err by some 1e-8 h², h = 1e-4.
TEST(RobustProblem, HasTheGradientOfTheDeviation) {
  FunctionProblem problem = curved_problem();
  RobustProblem robust(problem, Vector2d(a, b), Eigen::Vector3d(2.0, 3.0, 0.0));
  const double x = 1.5, y = 0.7, sigma = deviation(x, y);
  const double of_x = 2.0 * x * y, of_y = x * x + std::cos(y);
  const Vector2d expected((a * a * of_x * 2.0 * y + b * b * of_y * 2.0 * x) / sigma,
                          (a * a * of_x * 2.0 * x - b * b * of_y * std::sin(y)) / sigma);
  const Eigen::MatrixXd plain =
      problem.evaluate(Vector2d(x, y), Request::values_and_gradients).constraint_jacobian;
  const Eigen::MatrixXd found =
      robust.evaluate(Vector2d(x, y), Request::values_and_gradients).constraint_jacobian;
  EXPECT_NEAR(found(0, 0), plain(0, 0) + 2.0 * expected(0), 1e-9);
  EXPECT_NEAR(found(0, 1), plain(0, 1) + 2.0 * expected(1), 1e-9);
  EXPECT_NEAR((found.row(1) - plain.row(1)).norm(), 0.0, 1e-12);  // of a constant σ
  EXPECT_EQ(found.row(2), plain.row(2));
}

/// A variable at 0 whose whole range is a micrometre: c = sin(10⁶ x + 1) + 10⁶ y, σ = a 10⁶ |cos|.
TEST(RobustProblem, HasTheGradientOfTheDeviationOfASmallVariableAtZero) {
  const double large = 1e6, small = 1e-8;
  FunctionProblem problem({{"x", 0.0, -5e-7, 5e-7}, {"y", 0.0, -5e-7, 5e-7}},
                          {{"limit", -infinity, 3.0}}, [&](const Eigen::VectorXd& x, Request) {
                            Evaluation evaluation;
                            evaluation.objective_gradient = Vector2d(0.0, 0.0);
                            evaluation.constraints = Eigen::VectorXd::Constant(
                                1, std::sin(large * x(0) + 1.0) + large * x(1));
                            evaluation.constraint_jacobian.resize(1, 2);
                            evaluation.constraint_jacobian << large * std::cos(large * x(0) + 1.0),
                                large;
                            return evaluation;
                          });
  RobustProblem robust(problem, Vector2d(small, 0.0), Eigen::VectorXd::Constant(1, 2.0));
  const Evaluation found = robust.evaluate(Vector2d(0.0, 0.0), Request::values_and_gradients);
  const double expected = large * std::cos(1.0) - 2.0 * small * large * large * std::sin(1.0);
  EXPECT_NEAR(found.constraint_jacobian(0, 0), expected, 1e-6 * std::abs(expected));
}

class RobustOptimum : public testing::TestWithParam<std::string> {};

/// minimize x  subject to  1/x ≤ 1 with two deviations of x: 1/x + 2 s/x² = 1.
TEST_P(RobustOptimum, KeepsTheMargin) {
  FunctionProblem problem({{"x", 3.0, 0.1, 10.0}}, {{"limit", -infinity, 1.0}},
                          [](const Eigen::VectorXd& x, Request) {
                            Evaluation evaluation;
                            evaluation.objective = x(0);
                            evaluation.objective_gradient = Eigen::VectorXd::Ones(1);
                            evaluation.constraints = x.cwiseInverse();
                            evaluation.constraint_jacobian = -x.cwiseAbs2().cwiseInverse();
                            return evaluation;
                          });
  const double s = 0.05;
  RobustProblem robust(problem, Eigen::VectorXd::Constant(1, s), Eigen::VectorXd::Constant(1, 2.0));
  const Result result = solve(robust, SolveOptions{.backend = GetParam()});
  EXPECT_EQ(result.status, Status::verified) << result.message;
  EXPECT_NEAR(result.x(0), 0.5 * (1.0 + std::sqrt(1.0 + 8.0 * s)), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Backends, RobustOptimum, testing::ValuesIn(optimizer_names()),
                         name_of_backend);

}  // namespace
}  // namespace pleuel::test::robust_problem_test
