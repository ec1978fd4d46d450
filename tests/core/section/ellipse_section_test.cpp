#include <gtest/gtest.h>

#include "core/section/round_section.hpp"
#include "tests/core/section/section_derivative.hpp"

namespace pleuel::test::ellipse_section_test {
namespace {

TEST(EllipseSection, WithEqualAxesIsTheCircle) {
  const double d = 0.03;
  const auto ellipse = ellipse_section(d, d), circle = round_section(d, 0.0);
  EXPECT_NEAR(ellipse.area, circle.area, 1e-15 * circle.area);  // round-off, here and below
  EXPECT_NEAR(ellipse.inertia_y, circle.inertia_y, 1e-15 * circle.inertia_y);
  EXPECT_NEAR(ellipse.inertia_z, circle.inertia_z, 1e-15 * circle.inertia_z);
  EXPECT_NEAR(ellipse.torsion, circle.torsion, 1e-15 * circle.torsion);
  EXPECT_EQ(ellipse.radius_y, circle.radius_y);
  EXPECT_EQ(ellipse.radius_z, circle.radius_z);
  ASSERT_EQ(ellipse.points.size(), circle.points.size());
  for (std::size_t i = 0; i < circle.points.size(); ++i) {
    EXPECT_EQ(ellipse.points[i].y, circle.points[i].y);
    EXPECT_EQ(ellipse.points[i].z, circle.points[i].z);
    EXPECT_NEAR(ellipse.points[i].shear, circle.points[i].shear, 1e-15 * circle.points[i].shear);
  }
}

TEST(EllipseSection, SecondMomentsAreTheIntegralsOverItsArea) {
  const double width = 0.02, height = 0.05;
  const AreaMoments sum(width, height, 2000, [&](double y, double z) {
    return std::pow(2 * y / height, 2) + std::pow(2 * z / width, 2) < 1.0;
  });
  const auto section = ellipse_section(width, height);
  // The boundary cuts about 4 n of the n² cells at random: 5e-4 is 10 times what was measured.
  EXPECT_NEAR(section.area / sum.area, 1.0, 5e-4);
  EXPECT_NEAR(section.inertia_z / sum.yy, 1.0, 5e-4);
  EXPECT_NEAR(section.inertia_y / sum.zz, 1.0, 5e-4);
}

/// φ = c (1 − y²/a² − z²/b²) vanishes on the outline and has ∇²φ = −2 if c = a²b²/(a² + b²). Then
/// J = 2∫φ = πabc, and the shear at the ends of the axes is 2c/a and 2c/b, per J. The sum over
/// elliptic rings is another integral than the formula's.
TEST(EllipseSection, TorsionIsThatOfPrandtlsFunction) {
  const double width = 0.02, height = 0.05, a = height / 2, b = width / 2;
  const double c = 1.0 / (1 / (a * a) + 1 / (b * b));
  EXPECT_NEAR(-2 * c / (a * a) - 2 * c / (b * b), -2.0, 1e-14);
  double constant = 0.0;
  const int n = 2000;
  for (int i = 0; i < n; ++i) {  // rings of the relative radius r: dA = 2πab r dr
    const double r = (i + 0.5) / n;
    constant += 2 * c * (1 - r * r) * 2 * std::numbers::pi * a * b * r / n;
  }
  const auto section = ellipse_section(width, height);
  EXPECT_NEAR(section.torsion / constant, 1.0, 1e-6);  // midpoint rule: O(1/n²)
  for (const auto& point : section.points) {
    const double slope = point.y != 0.0 ? 2 * c / a : 2 * c / b;
    EXPECT_NEAR(point.shear, slope / section.torsion, 1e-14 * point.shear);
  }
  EXPECT_GT(section.points[2].shear, section.points[0].shear);  // largest at the minor axis
}

TEST(EllipseSection, DerivativesAreThoseOfTheComplexStepAndOfDifferences) {
  expect_right_derivatives([](const auto& size) { return ellipse_section(size[0], size[1]); },
                           {0.011, 0.023});
}

}  // namespace
}  // namespace pleuel::test::ellipse_section_test
