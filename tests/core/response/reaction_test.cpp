#include "core/base/eager_matrices.hpp"
#include "core/joints/joint_term.hpp"
#include "core/response/analysis.hpp"
#include "core/start/initial_state.hpp"
#include "tests/core/response/response_samples.hpp"
#include "tests/support/dense.hpp"
#include "tests/support/sample_name.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::reaction_test {
namespace {

using namespace response_samples;

class EveryReaction : public testing::TestWithParam<int> {};

/// What the joint's term does to the frame of its second body is the wrench about its origin:
/// translations −e · F, rotations −n · (M + (P₂ − r) × F), n = columns of A G. The equations of
/// joints with a map are in local numbers, and rows of frames are copies.
TEST_P(EveryReaction, IsWhatTheTermDoesToTheFrameOfTheSecondBody) {
  const SampleScene sample = all_samples()[GetParam()];
  const Model model = sample.build();
  const State all = random_state(model, 11);
  for (const JointModel& joint : model.joints) {
    if (joint.equations() == 0) continue;
    State state = all;
    if (joint.map) {
      LocalState local(*joint.map);
      local.set(*joint.map, all);
      state = local.local;
    }
    const Marker& marker = joint.topology.markers[1];
    const BodyFrame& frame = marker.frame;
    const auto term = pleuel::make_joint_term(joint.topology, joint.data, joint.derivatives);
    const Eigen::VectorXd rows =
        -residual_of(*term, state, ConstraintLevel::position).segment(frame.offset, frame.size());
    const Eigen::Vector3d force = reaction(model, joint.name, ResponseType::reaction_force, all);
    const Eigen::Vector3d moment = reaction(model, joint.name, ResponseType::reaction_moment, all);
    const FrameMotion<double> motion = frame_motion<double>(
        frame, state.q.segment(frame.offset, frame.size()),
        state.v.segment(frame.offset, frame.size()), state.a.segment(frame.offset, frame.size()));
    Eigen::Vector3d p = joint.data.points[1];
    for (std::size_t i = 0; i < 3; ++i) {
      if (marker.elastic[i] >= 0) p(i) += state.q(marker.elastic[i]);
    }
    const Eigen::Vector3d about_origin = moment + (motion.A * p).cross(force);
    const int translations = frame.translations();
    Eigen::VectorXd expected(frame.size());
    expected.head(translations) = frame.basis.transpose() * force;
    expected.tail(frame.rotations()) = (motion.A * motion.G).transpose() * about_origin;
    EXPECT_LE((rows - expected).norm(), 1e-12 * (1.0 + expected.norm())) << joint.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, EveryReaction, testing::Range(0, sample_count), sample_name);

constexpr double mass = 0.7, length = 0.4, speed = 3.0, gravity = 9.81;

RigidBody bob(const Point& at) {
  RigidBody body;
  body.at = at;
  body.mass = mass;
  body.inertia = {0.01, 0.02, 0.03, 0.0, 0.0, 0.0};
  return body;
}

Scene pendulum(JointType type, bool ground_first) {
  Scene scene;
  scene.gravity = {0.0, -gravity, 0.0};
  Body body{"bob", bob({0.0, -length, 0.0})};
  body.velocity = {speed, 0.0, 0.0};
  body.angular_velocity = {0.0, 0.0, speed / length};
  scene.bodies = {body};
  Joint joint;
  joint.name = "bearing";
  joint.type = type;
  joint.bodies = {ground_name, "bob"};
  if (!ground_first) std::swap(joint.bodies[0], joint.bodies[1]);
  scene.joints = {joint};
  return scene;
}

class Reaction : public testing::TestWithParam<EffectChoice> {
 protected:
  Model build(const Scene& scene) const {
    return build_model(scene, in_motion(GetParam()), {}, {});
  }
};

/// m g + m v²/L at the lowest point, upwards on the pendulum, downwards on the ground.
TEST_P(Reaction, OfAPendulumAtItsLowestPointIsWeightAndCentripetalForce) {
  const double expected = mass * gravity + mass * speed * speed / length;
  for (bool ground_first : {true, false}) {
    Model model = build(pendulum(JointType::revolute, ground_first));
    const State state = initial_state(model.mechanism).state;
    const Eigen::Vector3d force = reaction(model, "bearing", ResponseType::reaction_force, state);
    const double sign = ground_first ? 1.0 : -1.0;
    EXPECT_NEAR(force.y(), sign * expected, 1e-12 * expected);
    EXPECT_NEAR(force.x(), 0.0, 1e-12 * expected);
    EXPECT_NEAR(force.z(), 0.0, 1e-12 * expected);
    ResponseSettings settings;
    settings.type = ResponseType::reaction_force;
    settings.joint = "bearing";
    settings.direction = magnitude_direction;
    EXPECT_NEAR(observed(model, settings, state), expected, 1e-12 * expected);
  }
}

/// A body that is welded beside its centre of mass: the weld carries its weight and the moment
/// m g d about the weld's point.
TEST_P(Reaction, OfAWeldIsWeightAndItsMoment) {
  Scene scene = pendulum(JointType::fixed, true);
  scene.bodies = {{"bob", bob({0.3, -length, 0.0})}};
  Model model = build(scene);
  const State state = initial_state(model.mechanism).state;
  const Eigen::Vector3d force = reaction(model, "bearing", ResponseType::reaction_force, state);
  const Eigen::Vector3d moment = reaction(model, "bearing", ResponseType::reaction_moment, state);
  EXPECT_LE((force - Eigen::Vector3d(0, mass * gravity, 0)).norm(), 1e-12);
  EXPECT_LE((moment - Eigen::Vector3d(0, 0, mass * gravity * 0.3)).norm(), 1e-12);
}

/// The drive is a part of the joint: the moment about the axis is the drive's torque.
TEST_P(Reaction, ContainsTheTorqueOfTheDrive) {
  for (double sense : {1.0, -1.0}) {
    Scene scene = pendulum(JointType::revolute, true);
    scene.bodies = {{"bob", bob({0.3, -length, 0.0})}};
    scene.joints[0].axis = {0.0, 0.0, sense};
    scene.joints[0].drive = PolynomialFunction{{0.0, 2.0, 5.0}};
    Model model = build(scene);
    const State state = initial_state(model.mechanism).state;
    ResponseSettings settings;
    settings.type = ResponseType::drive_torque;
    settings.joint = "bearing";
    // Torque = I_z α + m (x a_y − y a_x) + m g x about the bearing, with α = 2 · 5 about the axis.
    const double about_z =
        (0.03 + mass * (0.3 * 0.3 + length * length)) * sense * 10.0 + mass * gravity * 0.3;
    EXPECT_NEAR(observed(model, settings, state), sense * about_z, 1e-12);
    EXPECT_NEAR(reaction(model, "bearing", ResponseType::reaction_moment, state).z(), about_z,
                1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Motions, Reaction, testing::Values(EffectChoice::off, EffectChoice::on),
                         [](const testing::TestParamInfo<EffectChoice>& motion) {
                           return motion.param == EffectChoice::on ? "Spatial" : "Planar";
                         });

/// f = 4t + 3t² for 1.2 s: power is torque times speed at every step, and its integral the change
/// of energy, ½ (I + m L²)(ω₁² − ω₀²) and of height. 2e-5: the trapezoidal rule and the scheme, of
/// second order, at 2400 steps (measured 8e-6).
TEST(Power, IsTorqueTimesSpeedAndItsIntegralTheChangeOfEnergy) {
  ProblemFile problem;
  problem.scene = pendulum(JointType::revolute, true);
  problem.scene.joints[0].drive = PolynomialFunction{{0.0, 4.0, 3.0}};
  problem.simulation.end_time = 1.2;
  problem.simulation.step = 5e-4;
  ResponseSettings torque, power, energy;
  torque.name = "torque";
  torque.type = ResponseType::drive_torque;
  torque.joint = "bearing";
  power = torque;
  power.name = "power";
  power.type = ResponseType::drive_power;
  energy = power;
  energy.name = "energy";
  energy.over_time = OverTime::integral;
  problem.responses = {torque, power, energy};
  const auto analysis = analyze(problem, {});
  const Eigen::VectorXd& time = analysis->trajectory.time;
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    const double rate = 4.0 + 6.0 * time(i);
    EXPECT_NEAR(analysis->histories[1](0, i), analysis->histories[0](0, i) * rate, 1e-9);
  }
  const double start = 4.0, end = 4.0 + 6.0 * 1.2, angle = 4.0 * 1.2 + 3.0 * 1.2 * 1.2;
  const double kinetic = 0.5 * (0.03 + mass * length * length) * (end * end - start * start);
  const double potential = mass * gravity * length * (1.0 - std::cos(angle));
  EXPECT_NEAR(analysis->reductions[2].value / (kinetic + potential), 1.0, 2e-5);
  EXPECT_EQ(analysis->responses[2].unit, "J");
}

}  // namespace
}  // namespace pleuel::test::reaction_test
