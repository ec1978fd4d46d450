#include <gtest/gtest.h>

#include "core/section/section_properties.hpp"

namespace pleuel::test::shear_coefficient_test {
namespace {

/// Cowper's coefficients meet: an ellipse with equal axes and a tube without hole are circles, a
/// thin tube has 2(1 + ν)/(4 + 3ν), a thin box without flanges is a rectangle.
TEST(ShearCoefficient, OfSectionsThatAreTheSameIsTheSame) {
  constexpr double nu = 0.3;
  const double circle = 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu);
  EXPECT_NEAR(round_shear_coefficient(nu, 0.0), circle, 1e-15);
  EXPECT_NEAR(ellipse_shear_coefficient(nu, 2.0, 2.0), circle, 1e-15);
  EXPECT_NEAR(round_shear_coefficient(nu, 1.0), 2.0 * (1.0 + nu) / (4.0 + 3.0 * nu), 1e-15);
  const double rectangle = rectangle_shear_coefficient(nu);
  EXPECT_NEAR(box_shear_coefficient(nu, {1.0, 1e-9, 0.01, 0.01}), rectangle, 1e-6);
  EXPECT_NEAR(i_shear_coefficient(nu, {1.0, 1e-9, 0.01, 0.01}), rectangle, 1e-6);
}

}  // namespace
}  // namespace pleuel::test::shear_coefficient_test
