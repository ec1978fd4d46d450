#include "core/mechanism/balanced_lu.hpp"

#include <Eigen/Geometry>

#include "core/base/eager_matrices.hpp"
#include "tests/support/test.hpp"

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

/// Against the rule of Sarrus.
TEST(BalancedLu, KnowsTheSignOfTheDeterminant) {
  int positive = 0;
  for (int seed = 1; seed <= 40; ++seed) {
    Eigen::Matrix3d a;
    for (int i = 0; i < 9; ++i) a(i / 3, i % 3) = std::sin(seed * (1.0 + 2.7 * i));
    if (seed % 3 == 0) a(1, 1) = 0.0;
    const double determinant = a.row(0).cross(a.row(1)).dot(a.row(2));
    BalancedLu lu;
    ASSERT_TRUE(lu.factorize(Eigen::MatrixXd(a).sparseView(0.0, 0.0)));
    EXPECT_EQ(lu.determinant_sign(), determinant > 0.0 ? 1 : -1) << seed;
    positive += determinant > 0.0;
  }
  EXPECT_GT(positive, 5);
  EXPECT_LT(positive, 35);
}

}  // namespace
}  // namespace pleuel::test::balanced_lu_test
