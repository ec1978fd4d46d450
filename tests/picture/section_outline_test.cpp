#include "picture/section_outline.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/model/scene_geometry.hpp"

namespace pleuel::test::section_outline_test {
namespace {

/// Area, ∫y² dA and ∫z² dA of a polygon by Green's theorem; anticlockwise ones count positive.
Eigen::Vector3d integrals(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d &a = points[i], &b = points[(i + 1) % points.size()];
    const double cross = a.x() * b.y() - b.x() * a.y();
    sum.x() += cross / 2.0;
    sum.y() += cross * (a.x() * a.x() + a.x() * b.x() + b.x() * b.x()) / 12.0;
    sum.z() += cross * (a.y() * a.y() + a.y() * b.y() + b.y() * b.y()) / 12.0;
  }
  return sum;
}

/// The outline against the closed forms that the mechanics uses.
void expect_properties(const Section& section, double tolerance) {
  const SectionOutline outline = section_outline(section, {});
  const SectionProperties<double> exact = resolve_section<double>(section, {});
  Eigen::Vector3d drawn = integrals(outline.outer);
  if (!outline.inner.empty()) drawn -= integrals(outline.inner);
  EXPECT_NEAR(drawn.x(), exact.area, tolerance * exact.area);
  EXPECT_NEAR(drawn.y(), exact.inertia_z, 2.0 * tolerance * exact.inertia_z);
  EXPECT_NEAR(drawn.z(), exact.inertia_y, 2.0 * tolerance * exact.inertia_y);
}

TEST(SectionOutline, OfCornersHasAreaAndInertiaOfTheSection) {
  constexpr double round_off = 1e-12;
  expect_properties(RectangleSection{0.02, 0.03}, round_off);
  expect_properties(BoxSection{0.04, 0.06, 0.003}, round_off);
  expect_properties(ISection{0.05, 0.08, 0.006, 0.004}, round_off);
}

/// A polygon of 32 corners in a circle lacks 1 − (32/2π) sin(2π/32) = 0.64 % of its area.
TEST(SectionOutline, OfRoundSectionsIsNearlyTheirs) {
  expect_properties(CircleSection{0.03}, 0.0065);
  expect_properties(EllipseSection{0.02, 0.05}, 0.0065);
  expect_properties(TubeSection{0.04, 0.004}, 0.0065);
}

/// A full tube and a full box have no hole.
TEST(SectionOutline, HasNoHoleWhereTheWallsMeet) {
  EXPECT_TRUE(section_outline(TubeSection{0.04, 0.02}, {}).inner.empty());
  EXPECT_TRUE(section_outline(BoxSection{0.04, 0.06, 0.02}, {}).inner.empty());
}

TEST(SectionOutline, OfAGeneralSectionHasItsRadiiOfGyration) {
  const GeneralSection section{6e-4, 2e-8, 4.5e-8, 1e-8, {{0.015, 0.01, 0.0}}};
  const Eigen::Vector3d drawn = integrals(section_outline(section, {}).outer);
  EXPECT_NEAR(drawn.y() / drawn.x(), 4.5e-8 / 6e-4, 1e-12);
  EXPECT_NEAR(drawn.z() / drawn.x(), 2e-8 / 6e-4, 1e-12);
  EXPECT_FALSE(section_outline(section, {}).is_exact);
}

}  // namespace
}  // namespace pleuel::test::section_outline_test
