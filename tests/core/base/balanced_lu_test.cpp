#include "core/base/balanced_lu.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace pleuel::test::balanced_lu_test {
namespace {

/// Rows and columns in units that differ by 10¹⁶, of a matrix of moderate condition.
TEST(BalancedLu, SolvesWhatUnitsMakeUneven) {
  constexpr int size = 6;
  Eigen::MatrixXd even = Eigen::MatrixXd::Zero(size, size);
  for (int i = 0; i < size; ++i) {
    even(i, i) = 2.0;
    if (i > 0) even(i, i - 1) = -1.0;
    if (i > 0) even(i - 1, i) = 0.5 * i;
  }
  Eigen::VectorXd rows(size), columns(size);
  rows << 1.0, 1e8, 1e-8, 1.0, 1e8, 1e-8;
  columns << 1e-8, 1.0, 1e8, 1e8, 1.0, 1e-8;
  const Eigen::MatrixXd uneven = rows.asDiagonal() * even * columns.asDiagonal();
  const Eigen::VectorXd expected = Eigen::VectorXd::LinSpaced(size, 1.0, 2.0);
  BalancedLu lu;
  ASSERT_TRUE(lu.factorize(uneven.sparseView(0.0, 0.0)));
  const Eigen::VectorXd found =
      columns.asDiagonal() * Eigen::VectorXd(lu.solve(rows.asDiagonal() * even * expected));
  EXPECT_LT((found - expected).norm(), 1e-13);
}

TEST(BalancedLu, TellsSingularMatrices) {
  Eigen::MatrixXd matrix(2, 2);
  matrix << 1.0, 2.0, 2.0, 4.0;
  EXPECT_FALSE(BalancedLu().factorize(matrix.sparseView()));
}

}  // namespace
}  // namespace pleuel::test::balanced_lu_test
