#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "picture/section_outline.hpp"
#include "tests/picture/picture_problems.hpp"

namespace pleuel::test::swept_beam_test {
namespace {

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
}  // namespace pleuel::test::swept_beam_test
