#include "core/section/rectangle_section.hpp"

#include <algorithm>
#include <functional>

#include <gtest/gtest.h>

#include "tests/core/section/section_derivative.hpp"

namespace pleuel::test::rectangle_section_test {
namespace {

struct KnownTorsion {
  double ratio, constant, tolerance;
};

/// J/(a b³) of a rectangle a ≥ b: Timoshenko & Goodier, Theory of Elasticity, §109, table (0.1406,
/// 0.196, 0.229, 0.249, 0.263, 0.281, 0.291, 0.312). The square to more digits is the well-known
/// 0.140577 (2.24923 for the square of half-side 1); all others to the three digits of the table.
TEST(RectangleTorsion, ConstantIsThatOfTheTable) {
  for (const auto& [ratio, constant, tolerance] : {KnownTorsion{1.0, 0.1405770, 1e-7},
                                                   {1.5, 0.196, 5e-4},
                                                   {2.0, 0.229, 5e-4},
                                                   {2.5, 0.249, 5e-4},
                                                   {3.0, 0.263, 5e-4},
                                                   {4.0, 0.281, 5e-4},
                                                   {5.0, 0.291, 5e-4},
                                                   {10.0, 0.312, 5e-4}}) {
    EXPECT_NEAR(rectangle_section(0.01 * ratio, 0.01).torsion / (ratio * 1e-8), constant, tolerance)
        << ratio;
  }
}

/// A thin strip has J = a b³/3 (1 − 0.630 b/a): Timoshenko & Goodier, §109.
TEST(RectangleTorsion, ConstantOfAStripIsOneThirdLessItsEnds) {
  const double a = 1.0, b = 1e-3;
  EXPECT_NEAR(rectangle_section(a, b).torsion / (a * b * b * b), (1 - 0.63025 * b / a) / 3, 1e-9);
}

/// τ_max = T/(k a b²) in the middle of the longer side; k = 0.208, 0.231, 0.246, 0.267, 0.282,
/// 0.312 in the same table, three digits.
TEST(RectangleTorsion, LargestShearIsThatOfTheTableInTheMiddleOfTheLongerSide) {
  for (const auto& [ratio, constant, tolerance] : {KnownTorsion{1.0, 0.208, 5e-4},
                                                   {1.5, 0.231, 5e-4},
                                                   {2.0, 0.246, 5e-4},
                                                   {3.0, 0.267, 5e-4},
                                                   {4.0, 0.282, 5e-4},
                                                   {10.0, 0.312, 5e-4}}) {
    const double b = 0.01, a = ratio * b;
    double largest = 0.0, lever = 0.0;
    for (const auto& point : rectangle_section(a, b).points) {  // a along z, b along y
      if (point.shear <= largest) continue;
      largest = point.shear;
      lever = std::abs(point.y);
    }
    EXPECT_NEAR(1.0 / (largest * a * b * b), constant, tolerance) << ratio;
    if (ratio > 1.0) {
      EXPECT_EQ(lever, b / 2);  // the longer side is the nearer one
    }
  }
}

/// Independent series: finite differences of Prandtl's stress function would be coarse; the other
/// Fourier expansion (over the longer side) converges to the same numbers.
double torsion_by_the_other_series(double a, double b) {
  const double pi = std::numbers::pi;
  double sum = 0.0;
  for (int n = 1; n < 4001; n += 2) sum += std::tanh(n * pi * b / (2 * a)) / std::pow(n, 5);
  return b * a * a * a / 3 * (1 - 192 * a / (std::pow(pi, 5) * b) * sum);
}

TEST(RectangleTorsion, DoesNotDependOnTheDirectionOfTheSeries) {
  for (double ratio : {1.0, 1.3, 2.0, 3.7}) {
    const double a = 0.02 * ratio, b = 0.02;
    // Cancellation costs the other series (a/b)² of its digits.
    EXPECT_NEAR(rectangle_section(a, b).torsion / torsion_by_the_other_series(a, b), 1.0, 1e-11)
        << ratio;
  }
}

TEST(RectangleSection, SwappingWidthAndHeightSwapsTheAxes) {
  const auto one = rectangle_section(0.012, 0.031), other = rectangle_section(0.031, 0.012);
  EXPECT_EQ(one.inertia_y, other.inertia_z);
  EXPECT_EQ(one.inertia_z, other.inertia_y);
  EXPECT_EQ(one.torsion, other.torsion);
  for (const auto& point : one.points) {
    const bool is_there =
        std::any_of(other.points.begin(), other.points.end(), [&](const StressPoint<double>& p) {
          return p.y == point.z && p.z == point.y && p.shear == point.shear;
        });
    EXPECT_TRUE(is_there);
  }
}

TEST(RectangleSection, IsSmoothWhereItBecomesASquare) {
  const double a = 0.02, d = 1e-6;
  const auto torsion = [&](double width) { return rectangle_section(width, a).torsion; };
  const auto shear = [&](double width) { return rectangle_section(width, a).points[4].shear; };
  for (const auto& [f, name] :
       {std::pair<std::function<double(double)>, const char*>{torsion, "torsion"},
        {shear, "shear"}}) {
    const double left = (f(a) - f(a * (1 - d))) / d, right = (f(a * (1 + d)) - f(a)) / d;
    // One-sided differences differ by f″ a² d plus round-off of 1e-16/d.
    EXPECT_NEAR(left / right, 1.0, 2e-5) << name;
  }
  // By symmetry both sides of a square count alike: a ∂J/∂a = b ∂J/∂b = 2 J (J ~ size⁴).
  const Dual width(a, Dual::Derivatives::Ones());
  EXPECT_NEAR(derivative_of(rectangle_section(width, Dual(a)).torsion) * a / torsion(a), 2.0,
              1e-12);
}

TEST(RectangleSection, SecondMomentsAreTheIntegralsOverItsArea) {
  const double width = 0.013, height = 0.029;
  const int n = 400;
  double area = 0.0, yy = 0.0, zz = 0.0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double y = ((i + 0.5) / n - 0.5) * height, z = ((j + 0.5) / n - 0.5) * width;
      const double cell = width * height / (n * n);
      area += cell;
      yy += cell * y * y;
      zz += cell * z * z;
    }
  }
  const auto section = rectangle_section(width, height);
  EXPECT_NEAR(section.area / area, 1.0, 1e-11);                   // a sum of 160000 cells
  EXPECT_NEAR(section.inertia_z / yy, 1.0, 1.0 / (n * n) * 1.1);  // midpoint rule: 1 − 1/n²
  EXPECT_NEAR(section.inertia_y / zz, 1.0, 1.0 / (n * n) * 1.1);
}

TEST(RectangleSection, DerivativesAreThoseOfTheComplexStepAndOfDifferences) {
  test::expect_right_derivatives(
      [](const auto& size) { return rectangle_section(size[0], size[1]); }, {0.011, 0.023});
}

}  // namespace
}  // namespace pleuel::test::rectangle_section_test
