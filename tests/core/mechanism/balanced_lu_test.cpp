#include "core/mechanism/balanced_lu.hpp"

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"

namespace pleuel::test::balanced_lu_test {
namespace {

/// An equation in a unit that is 10²¹ times as small: its 10 is no pivot beside the 1 of the other one,
/// which partial pivoting alone takes it for (and finds x₁ = 0).
TEST(BalancedLu, TakesNoPivotForItsUnit) {
  Eigen::MatrixXd matrix(2, 2);
  matrix << 10.0, 1e21, 1.0, 1.0;
  const Eigen::Vector2d expected(2.0, 1.0);
  BalancedLu lu;
  ASSERT_TRUE(lu.factorize(matrix.sparseView(0.0, 0.0)));
  EXPECT_LT((lu.solve(matrix * expected) - expected).norm(), 1e-14);
}

TEST(BalancedLu, TellsSingularMatrices) {
  Eigen::MatrixXd matrix(2, 2);
  matrix << 1.0, 2.0, 2.0, 4.0;
  EXPECT_FALSE(BalancedLu().factorize(matrix.sparseView()));
}

}  // namespace
}  // namespace pleuel::test::balanced_lu_test
