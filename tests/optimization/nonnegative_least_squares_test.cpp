#include <random>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "optimization/kkt_audit.hpp"

namespace pleuel::test::nonnegative_least_squares_test {
namespace {

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
  }
}

TEST(NonnegativeLeastSquares, TakesDependentAndZeroColumns) {
  std::mt19937 engine(2);
  for (int sample = 0; sample < 100; ++sample) {
    Eigen::MatrixXd matrix = random_matrix(engine, 4, 6);
    matrix.col(1) = 3.0 * matrix.col(0);
    matrix.col(2) = -matrix.col(0);
    matrix.col(3).setZero();
    expect_solution(matrix, random_matrix(engine, 4, 1));
  }
}

TEST(NonnegativeLeastSquares, DoesNotDependOnTheLengthOfColumns) {
  std::mt19937 engine(3);
  const Eigen::MatrixXd matrix = random_matrix(engine, 5, 3).cwiseAbs();
  const Eigen::VectorXd right = matrix * Eigen::Vector3d(1.0, 0.0, 2.0);
  const Eigen::Vector3d lengths(1e9, 1.0, 1e-9);
  const Eigen::VectorXd z = nonnegative_least_squares(matrix * lengths.asDiagonal(), right);
  EXPECT_TRUE(z.cwiseProduct(lengths).isApprox(Eigen::Vector3d(1.0, 0.0, 2.0), 1e-12));
}

TEST(NonnegativeLeastSquares, WithoutColumnsHasNoUnknowns) {
  EXPECT_EQ(nonnegative_least_squares(Eigen::MatrixXd(3, 0), Eigen::Vector3d::Ones()).size(), 0);
}

}  // namespace
}  // namespace pleuel::test::nonnegative_least_squares_test
