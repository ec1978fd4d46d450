#include <Eigen/LU>
#include <gtest/gtest.h>

#include "tests/support/dense.hpp"
#include "tests/support/sample_scenes.hpp"

namespace {

using namespace pleuel;

/// A rigid body held by one joint on the ground.
struct Freedom {
  JointType type;
  bool is_driven, is_point;
  int in_space, in_plane;  ///< degrees of freedom left
};

Scene scene_of(const Freedom& c) {
  Scene scene;
  Body body{"body", RigidBody{{0.3, 0.1, 0.0}, 1.0, {0.1, 0.2, 0.25, 0.0, 0.0, 0.0}}};
  if (c.is_point) body.shape = PointMass{{0.2, 0.1, 0.0}, 1.0};
  scene.bodies = {body};
  Joint joint;
  joint.name = "joint";
  joint.type = c.type;
  joint.bodies = {ground_name, "body"};
  joint.at = {0.2, 0.1, 0.0};
  const bool slides = c.type == JointType::prismatic || c.type == JointType::point_on_line;
  if (slides) joint.axis = {0.6, 0.8, 0.0};
  if (c.is_driven) joint.drive = ConstantSpeedDrive{2.0};
  scene.joints = {joint};
  // A second one about z, which tells the plane and takes no freedom: it holds another body.
  scene.bodies.push_back({"other", PointMass{{0.0, 0.0, 0.0}, 1.0}});
  Joint other;
  other.name = "other";
  other.bodies = {ground_name, "other"};
  other.at = {0.0, 0.0, 0.0};
  scene.joints.push_back(other);
  return scene;
}

/// Coordinates less the rank of Φ_q.
int freedom_of(const Scene& scene, EffectChoice spatial) {
  Model model = build_model(scene, {.spatial_motion = spatial}, {}, {});
  System& system = *model.mechanism.system;
  State state = model.mechanism.guess;
  System::Matrix matrix = system.make_matrix();
  system.tangent(state, {.q = 1.0}, ConstraintLevel::position, matrix);
  const Eigen::MatrixXd jacobian =
      Eigen::MatrixXd(matrix).bottomLeftCorner(system.multipliers(), system.coordinates());
  const auto rank = Eigen::FullPivLU<Eigen::MatrixXd>(jacobian).rank();
  EXPECT_EQ(rank, system.multipliers()) << "no equation says what another one says";
  return system.coordinates() - static_cast<int>(rank);
}

TEST(Joints, LeaveTheDegreesOfFreedomOfTheirKind) {
  for (const Freedom& c : {Freedom{JointType::revolute, false, false, 1, 1},
                           Freedom{JointType::revolute, true, false, 0, 0},
                           Freedom{JointType::prismatic, false, false, 1, 1},
                           Freedom{JointType::fixed, false, false, 0, 0},
                           Freedom{JointType::point_on_line, false, false, 4, 2},
                           Freedom{JointType::revolute, false, true, 0, 0},
                           Freedom{JointType::fixed, false, true, 0, 0},
                           Freedom{JointType::prismatic, false, true, 1, 1},
                           Freedom{JointType::point_on_line, false, true, 1, 1}}) {
    const Scene scene = scene_of(c);
    EXPECT_EQ(freedom_of(scene, EffectChoice::on), c.in_space) << static_cast<int>(c.type);
    EXPECT_EQ(freedom_of(scene, EffectChoice::off), c.in_plane) << static_cast<int>(c.type);
  }
}

TEST(Joints, AreClosedAtTheStartOfASceneThatIsDrawnClosed) {
  for (const SampleScene& sample : all_samples()) {
    Model model = sample.build();
    Eigen::VectorXd residual;
    model.mechanism.system->residual(model.mechanism.guess, ConstraintLevel::position, residual);
    EXPECT_LE(residual.tail(model.mechanism.system->multipliers()).lpNorm<Eigen::Infinity>(), 1e-15)
        << sample.name;
  }
}

}  // namespace
