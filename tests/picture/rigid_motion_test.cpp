#include <cmath>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "picture/motion.hpp"
#include "tests/picture/picture_problems.hpp"

namespace pleuel::test::rigid_motion_test {
namespace {

/// An elastic arm that a drive turns at 20 rad/s, without its elasticity: the tip is at
/// 0.4 m (cos ωt, sin ωt), to the end of the motion.
TEST(RigidMotion, OfAnElasticArmIsACircle) {
  const ProblemFile problem = turning_arm(R"("frame": "chord")");
  const Eigen::VectorXd x = start_design(problem);
  const Model model = build_model(problem.scene, problem.effects, {x.begin(), x.end()},
                                  {x.begin(), x.end()}, problem.sensitivity.invariants);
  const RigidMotion rigid =
      rigid_motion(problem.scene, model, problem.simulation.end_time, problem.simulation.step);
  const Motion& motion = rigid.motion;
  ASSERT_GT(motion.time.size(), 2);
  EXPECT_DOUBLE_EQ(motion.time(motion.time.size() - 1), problem.simulation.end_time);
  for (Eigen::Index i = 0; i < motion.time.size(); ++i) {
    const double angle = 20.0 * motion.time(i);
    const Eigen::Vector3d tip = motion.bodies.front().positions.col(i).tail<3>();
    EXPECT_NEAR(tip.x(), 0.4 * std::cos(angle), 1e-7);
    EXPECT_NEAR(tip.y(), 0.4 * std::sin(angle), 1e-7);
  }
  EXPECT_EQ(motion.bodies.front().stress.size(), 0);
}

}  // namespace
}  // namespace pleuel::test::rigid_motion_test
