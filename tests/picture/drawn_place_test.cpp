#include "picture/drawn_place.hpp"

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/response/analysis.hpp"
#include "tests/picture/picture_problems.hpp"

namespace pleuel::test::drawn_place_test {
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

}  // namespace
}  // namespace pleuel::test::drawn_place_test
