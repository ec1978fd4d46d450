#include "optimization/violation_step.hpp"

#include <random>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "optimization/kkt_audit.hpp"

namespace pleuel::test::violation_step_test {
namespace {

constexpr double box_weight = 30.0, regularization = 1e-4;  // as the header says

LinearizedLimits random_limits(std::mt19937& engine, Eigen::Index count, Eigen::Index variables) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto number = [&]() { return uniform(engine); };
  return {Eigen::VectorXd::NullaryExpr(count, number),
          Eigen::MatrixXd::NullaryExpr(count, variables, number)};
}

// The same minimum by its dual, a least-squares problem of the multipliers μ ≥ 0 of all rows and
// sides of the box: d = −Aᵀ μ / λ with μ = argmin ‖[Aᵀ/√λ; 1] μ − [0; r]‖².
Eigen::VectorXd step_by_dual(const LinearizedLimits& limits, const Eigen::VectorXd& down,
                             const Eigen::VectorXd& up) {
  const Eigen::Index n = down.size(), count = limits.residuals.size() + 2 * n;
  const Eigen::MatrixXd sides = box_weight * Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd a(count, n);
  a << limits.slopes, sides, -sides;
  Eigen::VectorXd r(count);
  r << limits.residuals, -box_weight * up, -box_weight * down;
  Eigen::MatrixXd matrix(n + count, count);
  matrix << a.transpose() / std::sqrt(regularization), Eigen::MatrixXd::Identity(count, count);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(matrix.rows());
  right.tail(count) = r;
  const Eigen::VectorXd step =
      -a.transpose() * nonnegative_least_squares(matrix, right) / regularization;
  return step.cwiseMin(up).cwiseMax(-down);
}

TEST(ViolationStep, IsThatOfTheDualProblem) {
  std::mt19937 engine(1);
  for (int sample = 0; sample < 300; ++sample) {
    const Eigen::Index variables = 1 + sample % 6, count = sample % 17;
    const LinearizedLimits limits = random_limits(engine, count, variables);
    const double size = sample % 3 == 0 ? 10.0 : 0.2;  // the box is of no account, or is
    const Eigen::VectorXd up = Eigen::VectorXd::Constant(variables, size), down = 0.5 * up;
    const Eigen::VectorXd step = violation_step(limits, down, up);
    EXPECT_LE((step - step_by_dual(limits, down, up)).norm(), 1e-8 * (1.0 + step.norm()))
        << "sample " << sample;
  }
}

// As many limits as a design of 200 variables has windows of time, most of them violated and with
// dependent rows: no direction within the box helps at the end.
TEST(ViolationStep, CannotBeImprovedWithManyLimits) {
  std::mt19937 engine(2);
  LinearizedLimits limits = random_limits(engine, 2000, 200);
  limits.slopes.bottomRows(500) = limits.slopes.topRows(500);
  const Eigen::VectorXd size = Eigen::VectorXd::Constant(200, 0.7);
  const Eigen::VectorXd step = violation_step(limits, size, size);
  const double least = limits.sum(step) + regularization * step.squaredNorm();
  EXPECT_LT(least, 0.9 * limits.sum(Eigen::VectorXd::Zero(200)));
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int sample = 0; sample < 200; ++sample) {
    const Eigen::VectorXd other =
        step + 0.1 * Eigen::VectorXd::NullaryExpr(200, [&]() { return uniform(engine); });
    EXPECT_GE(limits.sum(other) + regularization * other.squaredNorm(), least);
  }
}

TEST(ViolationStep, StaysWhereNothingIsViolated) {
  const LinearizedLimits limits{Eigen::Vector2d(-1.0, -2.0), Eigen::Matrix2d::Identity()};
  const Eigen::Vector2d size(0.5, 0.5);
  EXPECT_EQ(violation_step(limits, size, size), Eigen::Vector2d::Zero());
}

}  // namespace
}  // namespace pleuel::test::violation_step_test
