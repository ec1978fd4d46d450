#include "core/base/eager_matrices.hpp"
#include "core/integration/simulate.hpp"
#include "tests/support/places.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::drive_sense_test {
namespace {

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
      simulate(model.mechanism, {{.end_time = 0.05, .step = 1e-3, .spectral_radius = 0.8}});
  const BodyModel& bar = model.body("bar");
  const Eigen::VectorXd q =
      trajectory.columns().q().col(trajectory.steps()).segment(bar.frame.offset, bar.frame.size());
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(q.size());
  const FrameMotion<double> motion = frame_motion<double>(bar.frame, q, zero, zero);
  return {motion.A(1, 0),
          -trajectory.columns().lambda()(model.joint("hinge").drive_row, trajectory.steps())};
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

/// Two rigid beams that start at 0.5 and 1.9 rad against x, free but for one joint between them,
/// and a point mass on a revolute joint about +z that comes first and decides the normal of the
/// plane.
Scene inclined_beams(JointType type, const std::array<double, 3>& axis) {
  const auto beam = [](double x, double angle) {
    BeamBody body;
    body.from = {x, 0.0, 0.0};
    body.to = {x + 0.3 * std::cos(angle), 0.3 * std::sin(angle), 0.0};
    body.material = "steel";
    body.segments = {{RectangleSection{0.02, 0.02}, 1, {}}};
    body.is_rigid = true;
    return body;
  };
  Scene scene;
  scene.materials.push_back({"steel", 210e9, 0.3, 7850.0});
  scene.bodies = {{"mass", PointMass{{0.0, 0.0, 0.0}, 1.0}},
                  {"first", beam(0.0, 0.5)},
                  {"second", beam(0.1, 1.9)}};
  Joint pin;
  pin.name = "pin";
  pin.bodies = {ground_name, "mass"};
  pin.at = {0.0, 0.0, 0.0};
  Joint held = pin;
  held.name = "held";
  held.type = JointType::fixed;
  held.bodies = {ground_name, "first"};
  Joint joint;
  joint.name = "joint";
  joint.type = type;
  joint.bodies = {"first", "second"};
  joint.at = {0.1, 0.0, 0.0};
  joint.axis = axis;
  scene.joints = {pin, held, joint};
  return scene;
}

/// How far the second beam has turned about +z at the end.
double turn_of(const Scene& scene, EffectChoice spatial, double end_time) {
  EffectSettings effects;
  effects.spatial_motion = spatial;
  Model model = build_model(scene, effects, {}, {});
  EXPECT_EQ(model.body("second").frame.rotation == RotationCoordinates::angle,
            spatial == EffectChoice::automatic);
  const Trajectory trajectory =
      simulate(model.mechanism, {{.end_time = end_time, .step = 1e-3, .spectral_radius = 0.8}});
  State state;
  trajectory.states->load(trajectory.steps(), state);
  const FrameMotion<double> motion = frame_of(model.body("second"), state);
  return std::remainder(std::atan2(motion.A(1, 0), motion.A(0, 0)) - 1.9, 2 * std::acos(-1.0));
}

/// The angle of a drive counts from the start, whatever angles the bodies start at.
TEST(Drive, AboutMinusZCountsFromTheStartOfInclinedBodies) {
  for (JointType type : {JointType::planar, JointType::revolute, JointType::cylindrical}) {
    for (double sense : {1.0, -1.0}) {
      Scene scene = inclined_beams(type, {0.0, 0.0, sense});
      scene.joints.back().drive = Drive(PolynomialFunction{{0.0, 0.0, 20.0}});
      for (EffectChoice spatial : {EffectChoice::automatic, EffectChoice::on}) {
        if (type == JointType::cylindrical && spatial == EffectChoice::on) continue;  // slides
        EXPECT_NEAR(turn_of(scene, spatial, 0.1), sense * 20.0 * 0.01, 1e-9);
      }
    }
  }
}

/// A spring of 2 N m/rad that rests at 0.25 rad about the axis, on a beam of moment of inertia
/// m (L² + h²)/12 about its middle; on a planar joint it is free there: φ'' = k s₀ / I at first.
TEST(JointSpring, AboutMinusZPullsInclinedBodiesToItsRest) {
  const double length = 0.3, depth = 0.02, mass = 7850.0 * depth * depth * length;
  const double inertia = mass * (length * length + depth * depth) / 12;
  for (double sense : {1.0, -1.0}) {
    Scene scene = inclined_beams(JointType::planar, {0.0, 0.0, sense});
    scene.loads = {{"spring", JointForce{"joint", DrivenCoordinate::angle, 2.0, 0.0, 0.25, {}}}};
    const double frequency = std::sqrt(2.0 / inertia), time = 0.02;
    const double expected = sense * 0.25 * (1 - std::cos(frequency * time));
    for (EffectChoice spatial : {EffectChoice::automatic, EffectChoice::on}) {
      // The scheme's error: (ω h)²/12 of the answer, ω = 15 rad/s.
      EXPECT_NEAR(turn_of(scene, spatial, time) / expected, 1.0, 1e-3);
    }
  }
}

/// A cylindrical joint has two freedoms: two joints on one axis drive one of them each.
TEST(Drive, OfBothFreedomsOfACylindricalJointMakesAScrew) {
  Scene scene = inclined_beams(JointType::cylindrical, {0.0, 0.0, -1.0});
  scene.joints.back().drive = Drive(PolynomialFunction{{0.0, 0.0, 20.0}}, DrivenCoordinate::angle);
  Joint slide = scene.joints.back();
  slide.name = "slide";
  slide.drive = Drive(PolynomialFunction{{0.0, 0.0, 5.0}}, DrivenCoordinate::displacement);
  scene.joints.push_back(slide);
  Model model = build_model(scene, {}, {}, {});
  const Trajectory trajectory =
      simulate(model.mechanism, {{.end_time = 0.1, .step = 1e-3, .spectral_radius = 0.8}});
  State state;
  trajectory.states->load(trajectory.steps(), state);
  const FrameMotion<double> motion = frame_of(model.body("second"), state);
  const double angle = 1.9 - 20.0 * 0.01;
  EXPECT_NEAR(motion.A(0, 0), std::cos(angle), 1e-9);
  EXPECT_NEAR(motion.A(1, 0), std::sin(angle), 1e-9);
  EXPECT_LE((motion.r - Eigen::Vector3d(0.1, 0.0, -5.0 * 0.01)).norm(), 1e-9);
}

}  // namespace
}  // namespace pleuel::test::drive_sense_test
