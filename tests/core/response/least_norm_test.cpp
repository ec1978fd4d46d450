#include "core/base/eager_matrices.hpp"
#include "core/start/initial_state.hpp"
#include "core/start/redundancy.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/core/response/response_samples.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::least_norm_test {
namespace {

using namespace response_samples;

constexpr double mass = 20.0, width = 0.9, distance = 1.6, gravity = 9.81, turning = 3.0;
/// A tenth of the largest distance between joints and bodies.
constexpr double bearing = 0.1 * distance;

/// A door about z; its centre of mass is width/2 away from the axis.
/// @param lower, upper  heights of its hinges
Scene door(const Number& lower, const Number& upper) {
  Scene scene;
  scene.gravity = {0.0, 0.0, -gravity};
  RigidBody panel;
  panel.at = {0.5 * width, 0.0, 0.0};
  panel.mass = mass;
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
  const double pull = 0.5 * mass * turning * turning * 0.5 * width,
               torque = mass * gravity * 0.5 * width,
               square = distance * distance + 4 * bearing * bearing;
  const double couple = torque * distance / square,
               moment = 2 * torque * bearing * bearing / square;
  for (const auto& [hinge, sign] : {std::pair("lower", 1.0), std::pair("upper", -1.0)}) {
    const Eigen::Vector3d force = reaction(model, hinge, ResponseType::reaction_force, state),
                          about = reaction(model, hinge, ResponseType::reaction_moment, state);
    const Eigen::Vector3d expected(-pull + sign * couple, 0.0, 0.5 * mass * gravity);
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
  ResponseSettings settings;
  settings.type = ResponseType::drive_torque;
  const double inertia = 4.0 + mass * 0.25 * width * width;
  for (const char* hinge : {"lower", "upper"}) {
    settings.joint = hinge;
    EXPECT_NEAR(observed(model, settings, state), 0.5 * inertia * 4.0, 1e-10) << hinge;
  }
}

/// W^(1/2) λ = (Gᵀ W^(-1/2))⁺ Gᵀ λ₀ by a decomposition that finds the rank itself, and Gᵀ λ = Gᵀ
/// λ₀, at any λ₀ along the way of redundant mechanisms in space.
TEST(LeastNorm, IsThePseudoinverseOfAllConstraints) {
  for (const char* name : {"hard/bricard", "hard/redundant_slider_crank"}) {
    const ProblemFile problem = sample_problem(name, {"/simulation/end_time=0.3"});
    const auto analysis = analyze(problem, start_design(problem));
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
    for (ResponseType type : {ResponseType::reaction_force, ResponseType::reaction_moment}) {
      for (int direction : {0, 2, magnitude_direction}) {
        ResponseSettings settings;
        settings.name = hinge + std::to_string(static_cast<int>(type)) + std::to_string(direction);
        settings.type = type;
        settings.joint = hinge;
        settings.direction = direction;
        settings.over_time = OverTime::rms;
        problem.responses.push_back(settings);
      }
    }
  }
  return problem;
}

class GradientOfLeastNorm : public testing::TestWithParam<Formulation> {};

TEST_P(GradientOfLeastNorm, IsThatOfDifferencesAndOfTheAdjoint) {
  ProblemFile problem = falling_door();
  problem.simulation.formulation = GetParam();
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  ASSERT_EQ(analysis->model.mechanism.system->left_out().size(), 5u);
  const auto values = response_values(*analysis);
  const auto scaled = [&](const Eigen::MatrixXd& gradient) -> Eigen::MatrixXd {
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
}  // namespace pleuel::test::least_norm_test
