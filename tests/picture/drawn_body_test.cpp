#include <Eigen/Geometry>

#include "core/base/eager_matrices.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/response/analysis.hpp"
#include "picture/drawn_place.hpp"
#include "picture/section_outline.hpp"
#include "tests/picture/picture_problems.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::drawn_body_test {
namespace {

Design<double> start_of(const ProblemFile& problem) {
  const Eigen::VectorXd x = start_design(problem);
  return {x.begin(), x.end()};
}

/// The place at t = 0, global axes [m]: the inverse of drawn_place().
Eigen::Vector3d position_at_start(const Scene& scene, const DrawnPlace& place,
                                  const Design<double>& design) {
  if (place.body < 0) return place.point;
  const Body& holder = scene.bodies[place.body];
  if (const auto* beam = std::get_if<BeamBody>(&holder.shape); beam && place.share >= 0.0) {
    const Eigen::Vector3d from = resolve_point(beam->from, design),
                          to = resolve_point(beam->to, design);
    return from + place.share * (to - from);
  }
  const Pose<double> pose = body_pose(holder, design);
  return pose.origin + pose.rotation * place.point;
}

TEST(DrawnPlace, LiesWhereTheFilePutsIt) {
  const ProblemFile problem = turning_arm(R"("frame": "tangent")");
  const Design<double> x = start_of(problem);
  const Point quarter = {Number(0.1), Number(0.0), Number(0.0)};
  for (const char* body : {"arm", "ball", "ground"}) {
    const DrawnPlace place = drawn_place(problem.scene, body, quarter, x);
    EXPECT_LT((position_at_start(problem.scene, place, x) - Eigen::Vector3d(0.1, 0, 0)).norm(),
              1e-15)
        << body;
  }
  EXPECT_DOUBLE_EQ(drawn_place(problem.scene, "arm", quarter, x).share, 0.25);
  EXPECT_EQ(drawn_place(problem.scene, "ground", quarter, x).body, -1);
}

/// A rigid beam holds points beside its axis, too.
TEST(DrawnPlace, BesideARigidBeamIsAPointOfItsFrame) {
  const ProblemFile problem = turning_arm(R"("rigid": true)");
  const Design<double> x = start_of(problem);
  const Point beside = {Number(0.1), Number(0.05), Number(0.0)};
  const DrawnPlace place = drawn_place(problem.scene, "arm", beside, x);
  EXPECT_LT(place.share, 0.0);
  EXPECT_LT((position_at_start(problem.scene, place, x) - Eigen::Vector3d(0.1, 0.05, 0)).norm(),
            1e-15);
}

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

/// By the divergence theorem, of faces that are fans of triangles; of points behind a surface that
/// is not closed, or turned inside out, it is another number.
double volume(const SweptSurface& surface) {
  double sum = 0.0;
  for (const std::vector<int>& face : surface.faces) {
    const Eigen::Vector3d a = surface.points.col(face[0]);
    for (std::size_t k = 2; k < face.size(); ++k) {
      const Eigen::Vector3d b = surface.points.col(face[k - 1]), c = surface.points.col(face[k]);
      sum += a.dot(b.cross(c)) / 6.0;
    }
  }
  return sum;
}

SweptSurface surface_of(const ProblemFile& problem, int step) {
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const Motion motion = sample_motion(problem.scene, *analysis, {0, step});
  return swept_beam(std::get<BeamBody>(problem.scene.bodies.front().shape),
                    Design<double>(x.begin(), x.end()), motion.bodies.front(), 1);
}

TEST(SweptBeam, OfARigidArmEnclosesItsVolume) {
  const SweptSurface surface = surface_of(turning_arm(R"("rigid": true)"), 60);
  EXPECT_NEAR(volume(surface), 0.4 * 0.01 * 0.02, 1e-12);
  EXPECT_EQ(surface.stress.size(), 0);
}

/// 32 corners of a circle of diameter d enclose 32/2 sin(2π/32) d²/4.
TEST(SweptBeam, OfATubeEnclosesItsWallOnly) {
  const SweptSurface surface =
      surface_of(turning_arm(R"("rigid": true)",
                             {R"(/scene/bodies/arm/section={"type": "tube", "outer_diameter": 0.03,
                      "thickness": 0.005})"}),
                 30);
  const double corners = 16.0 * std::sin(2.0 * M_PI / 32.0) / 4.0;
  EXPECT_NEAR(volume(surface), 0.4 * corners * (0.03 * 0.03 - 0.02 * 0.02), 1e-12);
}

BeamBody& arm_of(ProblemFile& problem) {
  return std::get<BeamBody>(problem.scene.bodies.front().shape);
}

TEST(SweptBeam, OfSegmentsHasTheSectionOfEach) {
  ProblemFile problem = turning_arm(R"("rigid": true)");
  ProblemFile other = turning_arm(R"("rigid": true)", {"/scene/bodies/arm/section/width=0.03"});
  Segment first = arm_of(problem).segments.front(), second = arm_of(other).segments.front();
  first.fraction = 0.3;
  second.fraction = 0.7;
  arm_of(problem).segments = {first, second};
  EXPECT_NEAR(volume(surface_of(problem, 30)), 0.4 * 0.02 * (0.3 * 0.01 + 0.7 * 0.03), 1e-12);
}

TEST(SweptBeam, OfAnElasticArmHasStressAtItsPoints) {
  const SweptSurface surface = surface_of(turning_arm(R"("frame": "tangent")"), 60);
  ASSERT_EQ(surface.stress.size(), surface.points.cols());
  EXPECT_GT(surface.stress.maxCoeff(), 0.0);
  // Bent by some µm: the volume changes little.
  EXPECT_NEAR(volume(surface), 0.4 * 0.01 * 0.02, 1e-3 * 0.4 * 0.01 * 0.02);
}

}  // namespace
}  // namespace pleuel::test::drawn_body_test
