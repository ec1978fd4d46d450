#include "core/base/relative_error.hpp"

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"

namespace pleuel::test::relative_error_test {
namespace {

TEST(RelativeError, OfAValueIsRelativeToTheReference) {
  EXPECT_DOUBLE_EQ(value_error(1.01, 1.0, 1.0), 0.01 + (1.01 - 1.0 - 0.01));
}

TEST(RelativeError, NearZeroIsRelativeToAThousandthOfTheMotion) {
  EXPECT_DOUBLE_EQ(value_error(1e-6, 0.0, 1.0), 1e-3);
}

TEST(RelativeError, OfEqualNumbersIsZeroEvenWhereAllIsZero) {
  EXPECT_EQ(value_error(0.0, 0.0, 0.0), 0.0);
  EXPECT_EQ(gradient_error(Eigen::Vector2d(0, 0), Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 1), 0),
            0.0);
}

TEST(RelativeError, OfAGradientDoesNotDependOnTheUnitsOfTheVariables) {
  const Eigen::Vector2d x(0.02, 3.0), reference(5.0, -0.1), gradient(5.1, -0.09);
  const double error = gradient_error(gradient, reference, x, 1.0);
  const Eigen::Vector2d units(1000.0, 1e-6);  // variables in mm and MPa: x grows, gradients shrink
  EXPECT_NEAR(gradient_error(gradient.cwiseQuotient(units), reference.cwiseQuotient(units),
                             x.cwiseProduct(units), 1.0),
              error, 1e-14);
}

}  // namespace
}  // namespace pleuel::test::relative_error_test
