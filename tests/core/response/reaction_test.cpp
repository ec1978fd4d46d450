#include "core/base/eager_matrices.hpp"
#include "core/joints/joint_term.hpp"
#include "core/response/analysis.hpp"
#include "core/start/initial_state.hpp"
#include "core/start/redundancy.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/core/response/response_samples.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/dense.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/sample_scenes.hpp"
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
    const Eigen::Vector3d force = reaction(model, joint.name, ReactionKind::force, all);
    const Eigen::Vector3d moment = reaction(model, joint.name, ReactionKind::moment, all);
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
  RigidBody body{.at = at, .mass = mass, .inertia = {0.01, 0.02, 0.03, 0.0, 0.0, 0.0}};
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
    const Eigen::Vector3d force = reaction(model, "bearing", ReactionKind::force, state);
    const double sign = ground_first ? 1.0 : -1.0;
    EXPECT_NEAR(force.y(), sign * expected, 1e-12 * expected);
    EXPECT_NEAR(force.x(), 0.0, 1e-12 * expected);
    EXPECT_NEAR(force.z(), 0.0, 1e-12 * expected);
    const ReactionResponse whole{"bearing", ReactionKind::force, magnitude_direction};
    EXPECT_NEAR(observed(model, whole, state), expected, 1e-12 * expected);
  }
}

/// A body that is welded beside its centre of mass: the weld carries its weight and the moment
/// m g d about the weld's point.
TEST_P(Reaction, OfAWeldIsWeightAndItsMoment) {
  Scene scene = pendulum(JointType::fixed, true);
  scene.bodies = {{"bob", bob({0.3, -length, 0.0})}};
  Model model = build(scene);
  const State state = initial_state(model.mechanism).state;
  const Eigen::Vector3d force = reaction(model, "bearing", ReactionKind::force, state);
  const Eigen::Vector3d moment = reaction(model, "bearing", ReactionKind::moment, state);
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
    const DriveResponse torque{"bearing", DriveNumber::torque};
    // Torque = I_z α + m (x a_y − y a_x) + m g x about the bearing, with α = 2 · 5 about the axis.
    const double about_z =
        (0.03 + mass * (0.3 * 0.3 + length * length)) * sense * 10.0 + mass * gravity * 0.3;
    EXPECT_NEAR(observed(model, torque, state), sense * about_z, 1e-12);
    EXPECT_NEAR(reaction(model, "bearing", ReactionKind::moment, state).z(), about_z, 1e-12);
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
  const DriveResponse torque{"bearing", DriveNumber::torque}, power{"bearing", DriveNumber::power};
  problem.responses = {{"torque", torque}, {"power", power}, {"energy", power, OverTime::integral}};
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

constexpr double panel_mass = 20.0, width = 0.9, distance = 1.6, turning = 3.0;
/// A tenth of the largest distance between joints and bodies.
constexpr double bearing = 0.1 * distance;

/// A door about z; its centre of mass is width/2 away from the axis.
/// @param lower, upper  heights of its hinges
Scene door(const Number& lower, const Number& upper) {
  Scene scene;
  scene.gravity = {0.0, 0.0, -gravity};
  RigidBody panel;
  panel.at = {0.5 * width, 0.0, 0.0};
  panel.mass = panel_mass;
  panel.inertia = {2.0, 3.0, 4.0, 0.0, 0.0, 0.0};
  Body body{"door", panel};
  body.velocity = {0.0, turning * 0.5 * width, 0.0};
  body.angular_velocity = {0.0, 0.0, turning};
  scene.bodies = {body};
  for (const auto& [name, height] : {std::pair("lower", lower), std::pair("upper", upper)}) {
    Joint hinge;
    hinge.name = name;
    hinge.bodies = {ground_name, "door"};
    hinge.at = {0.0, 0.0, height};
    scene.joints.push_back(hinge);
  }
  return scene;
}

/// Each hinge of a turning door carries half its weight and half the centripetal force m ω² w/2.
/// The weight turns it by T = m g w/2 about y; of forces ±F at the hinges and moments M in them
/// with F d + 2 M = T, 2 F² + 2 M²/ℓ² is least for F = T d/(d² + 4ℓ²), M = 2 T ℓ²/(d² + 4ℓ²).
TEST(LeastNorm, SharesTheLoadOfADoorBetweenItsHinges) {
  Model model = build_model(door(-0.5 * distance, 0.5 * distance), {}, {}, {});
  ASSERT_EQ(model.mechanism.system->left_out().size(), 5u);
  const State state = initial_state(model.mechanism).state;
  const double pull = 0.5 * panel_mass * turning * turning * 0.5 * width,
               torque = panel_mass * gravity * 0.5 * width,
               square = distance * distance + 4 * bearing * bearing;
  const double couple = torque * distance / square,
               moment = 2 * torque * bearing * bearing / square;
  for (const auto& [hinge, sign] : {std::pair("lower", 1.0), std::pair("upper", -1.0)}) {
    const Eigen::Vector3d force = reaction(model, hinge, ReactionKind::force, state),
                          about = reaction(model, hinge, ReactionKind::moment, state);
    const Eigen::Vector3d expected(-pull + sign * couple, 0.0, 0.5 * panel_mass * gravity);
    EXPECT_LE((force - expected).norm(), 1e-11 * expected.norm()) << hinge;
    EXPECT_LE((about - Eigen::Vector3d(0.0, -moment, 0.0)).norm(), 1e-11 * torque) << hinge;
  }
}

/// Two hinges whose drives do the same: each does half of it.
TEST(LeastNorm, SharesATorqueBetweenTwoDrives) {
  Scene scene = door(-0.5 * distance, 0.5 * distance);
  const PolynomialFunction law{{0.0, 0.0, 2.0}};
  for (Joint& hinge : scene.joints) hinge.drive = law;
  Model model = build_model(scene, {}, {}, {});
  ASSERT_EQ(model.mechanism.system->left_out().size(), 6u);
  const State state = initial_state(model.mechanism).state;
  const double inertia = 4.0 + panel_mass * 0.25 * width * width;
  for (const char* hinge : {"lower", "upper"}) {
    const DriveResponse torque{hinge, DriveNumber::torque};
    EXPECT_NEAR(observed(model, torque, state), 0.5 * inertia * 4.0, 1e-10) << hinge;
  }
}

/// W^(1/2) λ = (Gᵀ W^(-1/2))⁺ Gᵀ λ₀ by a decomposition that finds the rank itself, and Gᵀ λ = Gᵀ
/// λ₀, at any λ₀ along the way of redundant mechanisms in space.
TEST(LeastNorm, IsThePseudoinverseOfAllConstraints) {
  for (const char* name : {"hard/bricard", "hard/redundant_slider_crank"}) {
    const auto [problem, x, analysis] = AtStart(sample_problem(name, {"/simulation/end_time=0.3"}));
    Mechanism& mechanism = analysis->model.mechanism;
    System& system = *mechanism.system;
    const int n = system.coordinates(), m = system.multipliers();
    LeastNorm norm(mechanism);
    System::Matrix matrix = system.make_matrix();
    State state;
    for (const int step : {0, 20, analysis->trajectory.steps()}) {
      analysis->trajectory.states->load(step, state);
      state.lambda = random_vector(m, 7);
      system.tangent(state, {.q = 1.0}, ConstraintLevel::position, matrix);
      const Eigen::MatrixXd pull = Eigen::MatrixXd(matrix).topRightCorner(n, m);
      const Eigen::VectorXd root = mechanism.reaction_weight.cwiseSqrt();
      const Pseudoinverse inverse = pseudoinverse(pull * root.cwiseInverse().asDiagonal(), 1e-8);
      ASSERT_EQ(inverse.rank, m - static_cast<int>(system.left_out().size())) << name;
      const Eigen::VectorXd expected = (inverse.matrix * (pull * state.lambda)).cwiseQuotient(root);
      norm.set(state);
      const Eigen::VectorXd found = norm.apply(state.lambda);
      EXPECT_LE((pull * (found - state.lambda)).norm(), 1e-8 * (pull * state.lambda).norm())
          << name;
      EXPECT_LE((found - expected).norm(), 1e-8 * expected.norm()) << name << ", step " << step;
    }
  }
}

/// A door that falls about an axis that is not upright, with hinges, mass and width as variables.
ProblemFile falling_door() {
  ProblemFile problem;
  problem.scene = door(Number::bound(0), Number::bound(1));
  problem.scene.gravity = {2.0, 3.0, -9.0};
  auto& panel = std::get<RigidBody>(problem.scene.bodies[0].shape);
  panel.at = {Number::bound(2), 0.1, 0.2};
  panel.mass = Number::bound(3);
  problem.variables = {{"lower", -0.7, -1.0, 0.0, ""},
                       {"upper", 0.8, 0.0, 1.0, ""},
                       {"middle", 0.45, 0.1, 1.0, ""},
                       {"mass", 20.0, 1.0, 50.0, ""}};
  problem.scene.bodies[0].velocity = {0.0, 0.0, 0.0};
  problem.simulation.end_time = 0.2;
  problem.simulation.step = 2e-3;
  problem.simulation.newton_tolerance = 1e-13;
  for (const char* hinge : {"lower", "upper"}) {
    for (ReactionKind kind : {ReactionKind::force, ReactionKind::moment}) {
      for (int direction : {0, 2, magnitude_direction}) {
        problem.responses.push_back({hinge + number(kind) + std::to_string(direction),
                                     ReactionResponse{hinge, kind, direction}, OverTime::rms});
      }
    }
  }
  return problem;
}

class GradientOfLeastNorm : public testing::TestWithParam<Formulation> {};

TEST_P(GradientOfLeastNorm, IsThatOfDifferencesAndOfTheAdjoint) {
  ProblemFile problem = falling_door();
  problem.simulation.formulation = GetParam();
  const auto [x, analysis] = started(problem);
  ASSERT_EQ(analysis->model.mechanism.system->left_out().size(), 5u);
  const auto values = response_values(*analysis);
  const auto scaled = [&x = x](const Eigen::MatrixXd& gradient) -> Eigen::MatrixXd {
    return gradient * x.cwiseAbs().asDiagonal();
  };
  const Eigen::MatrixXd direct = scaled(sampled_gradients(*analysis, values, ExactMethod::direct)),
                        adjoint =
                            scaled(sampled_gradients(*analysis, values, ExactMethod::adjoint));
  EXPECT_LE((adjoint - direct).norm(), 1e-10 * direct.norm());
  // Central differences err as the square of the step, down to round-off.
  std::vector<double> errors;
  for (const double step : {1e-2, 1e-3, 1e-4}) {
    errors.push_back((scaled(central_differences(problem, x, step)) - direct).norm() /
                     direct.norm());
  }
  EXPECT_NEAR(errors[0] / errors[1], 100.0, 5.0);
  EXPECT_LE(errors[2], 1e-7);
}

INSTANTIATE_TEST_SUITE_P(Formulations, GradientOfLeastNorm,
                         testing::Values(Formulation{},
                                         Formulation{ConstraintForm::stabilized_index_2},
                                         Formulation{ConstraintForm::index_1},
                                         Formulation{ConstraintForm::index_1, 0.0, true}),
                         named_by([](const Formulation& formulation) {
                           if (formulation.is_projected) return "index_1_projected";
                           switch (formulation.constraints) {
                             case ConstraintForm::index_1:
                               return "index_1";
                             case ConstraintForm::stabilized_index_2:
                               return "stabilized_index_2";
                             default:
                               return "index_3";
                           }
                         }));

}  // namespace
}  // namespace pleuel::test::reaction_test
