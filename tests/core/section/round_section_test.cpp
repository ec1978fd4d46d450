#include "core/section/round_section.hpp"

#include <gtest/gtest.h>

#include "tests/core/section/section_derivative.hpp"

namespace pleuel::test::round_section_test {
namespace {

TEST(RoundSection, SecondMomentsAreTheIntegralsOverItsArea) {
  const double outer = 0.03, inner = 0.021;
  const int n = 2000;
  double area = 0.0, polar = 0.0;  // rings: dA = 2πr dr
  for (int i = 0; i < n; ++i) {
    const double dr = (outer - inner) / 2 / n, r = inner / 2 + (i + 0.5) * dr;
    area += 2 * std::numbers::pi * r * dr;
    polar += 2 * std::numbers::pi * r * r * r * dr;
  }
  const auto tube = round_section(outer, inner);
  EXPECT_NEAR(tube.area / area, 1.0, 1e-12);
  EXPECT_NEAR((tube.inertia_y + tube.inertia_z) / polar, 1.0, 1e-6);  // midpoint rule: O(1/n²)
  EXPECT_EQ(tube.inertia_y, tube.inertia_z);
  EXPECT_NEAR(tube.torsion / polar, 1.0, 1e-6);
}

TEST(RoundSection, TubeWithoutHoleIsTheCircle) {
  const double d = 0.03;
  const auto circle = round_section(d, 0.0), tube = round_section(d, 1e-9);
  EXPECT_NEAR(tube.area, circle.area, 3e-15 * circle.area);  // (1e-9/0.03)² of it is missing
  EXPECT_NEAR(tube.torsion, circle.torsion, 1e-15 * circle.torsion);
  EXPECT_NEAR(circle.area, std::numbers::pi * d * d / 4, 1e-15 * circle.area);
}

TEST(RoundSection, TubeIsTheDifferenceOfTwoCircles) {
  const auto tube = round_section(0.03, 0.02), outer = round_section(0.03, 0.0),
             inner = round_section(0.02, 0.0);
  EXPECT_NEAR(tube.area, outer.area - inner.area, 1e-15 * outer.area);
  EXPECT_NEAR(tube.inertia_z, outer.inertia_z - inner.inertia_z, 1e-15 * outer.inertia_z);
}

/// τ = 16 T/(π d³) for a solid shaft.
TEST(RoundSection, ShearOfAShaftIsThatOfTheTextbook) {
  const double d = 0.03;
  const auto shaft = round_section(d, 0.0);
  for (const auto& point : shaft.points) {
    EXPECT_NEAR(point.shear, 16 / (std::numbers::pi * d * d * d), 1e-12 * point.shear);
    EXPECT_NEAR(std::hypot(point.y, point.z), d / 2, 1e-17);
  }
}

TEST(RoundSection, DerivativesAreThoseOfTheComplexStepAndOfDifferences) {
  test::expect_right_derivatives([](const auto& size) { return round_section(size[0], size[1]); },
                                 {0.03, 0.02});
}

}  // namespace
}  // namespace pleuel::test::round_section_test
