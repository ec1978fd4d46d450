#include <gtest/gtest.h>

#include "core/integration/simulate.hpp"
#include "core/model/model.hpp"

namespace {

using namespace pleuel;

/// A bar that is driven about `axis`, and a point mass on a revolute joint about +z that comes
/// first and decides which normal the plane gets.
Scene driven_bar(const std::array<double, 3>& axis) {
  Scene scene;
  scene.bodies = {{"mass", PointMass{{0.0, 0.0, 0.0}, 1.0}},
                  {"bar", RigidBody{{0.2, 0.0, 0.0}, 1.0, {0.1, 0.1, 0.1, 0.0, 0.0, 0.0}}}};
  Joint pin;
  pin.name = "pin";
  pin.bodies = {ground_name, "mass"};
  pin.at = {0.0, 0.0, 0.0};
  Joint hinge;
  hinge.name = "hinge";
  hinge.bodies = {ground_name, "bar"};
  hinge.at = {0.2, 0.0, 0.0};
  hinge.axis = axis;
  hinge.drive = RampToSpeedDrive{2.0, 0.1};
  scene.joints = {pin, hinge};
  return scene;
}

struct Outcome {
  double sine;    ///< of the angle of the bar, about +z
  double torque;  ///< of the drive
};

/// While the drive accelerates.
Outcome run(const std::array<double, 3>& axis, EffectChoice spatial) {
  EffectSettings effects;
  effects.spatial_motion = spatial;
  Model model = build_model(driven_bar(axis), effects, {}, {});
  const Trajectory trajectory =
      simulate(model.mechanism, {.end_time = 0.05, .step = 1e-3, .spectral_radius = 0.8});
  const BodyModel& bar = model.body("bar");
  const Eigen::VectorXd q =
      trajectory.q.col(trajectory.steps()).segment(bar.frame.offset, bar.frame.size());
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(q.size());
  const FrameMotion<double> motion = frame_motion<double>(bar.frame, q, zero, zero);
  return {motion.A(1, 0), -trajectory.lambda(model.joint("hinge").drive_row, trajectory.steps())};
}

TEST(Drive, TurnsAboutTheAxisOfItsJointInThePlaneAsInSpace) {
  for (const auto& axis : {std::array{0.0, 0.0, 1.0}, std::array{0.0, 0.0, -1.0}}) {
    const Outcome plane = run(axis, EffectChoice::automatic), space = run(axis, EffectChoice::on);
    EXPECT_NEAR(plane.sine, space.sine, 1e-9);
    EXPECT_NEAR(plane.torque, space.torque, 1e-3 * std::abs(space.torque));
    EXPECT_GT(plane.sine * axis[2], 0.0);
    EXPECT_GT(plane.torque, 0.0) << "it accelerates in its own sense";
  }
}

}  // namespace
