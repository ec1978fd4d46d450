#include "core/base/eager_matrices.hpp"
#include "core/integration/checkpointed_loop.hpp"
#include "core/integration/projection.hpp"
#include "core/integration/simulation_options.hpp"
#include "core/integration/step_equations.hpp"
#include "core/integration/time_loop.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/model/model.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"
#include "core/start/initial_state.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/files.hpp"
#include "tests/support/model_state.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/scheme_case.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::step_test {
namespace {

class EquationsOfAStep : public testing::TestWithParam<int> {
 protected:
  SampleScene sample_ = all_samples()[GetParam()];
  Model model_ = sample_.build();
};

Eigen::VectorXd random_direction(Eigen::Index size) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return Eigen::VectorXd::NullaryExpr(size, [&] { return uniform(random); });
}

/// Of all formulations, at a state far from any solution, along a random change of the unknowns.
TEST_P(EquationsOfAStep, HaveTheTangentOfTheirResidual) {
  for (const Formulation& formulation : {index_3, stabilized, index_1, baumgarte}) {
    StepEquations equations(model_.mechanism, make_scheme(alpha, 1e-2, 0.8), formulation);
    StepState old = equations.make_state(random_state(model_, 3));
    equations.begin(old);
    StepState state = old;
    state.increment.setZero();
    equations.apply(1e-3 * random_direction(equations.size()), state);
    const Eigen::Index n = model_.mechanism.system->coordinates();
    Eigen::VectorXd along = 1e-3 * random_direction(equations.size()).reverse();
    along.head(n) = along.head(n).cwiseProduct(model_.mechanism.scale.cwiseMin(1.0)).eval();
    const auto residual_at = [&](double s) {
      StepState moved = state;
      equations.apply(s * along, moved);
      Eigen::VectorXd residual(equations.size());
      equations.residual(moved, residual);
      return residual;
    };
    System::Matrix matrix = equations.make_matrix();
    Eigen::VectorXd residual(equations.size());
    equations.linearize(state, residual, matrix);
    EXPECT_LE((residual - residual_at(0.0)).lpNorm<Eigen::Infinity>(),
              1e-13 * residual.lpNorm<Eigen::Infinity>());
    const Eigen::VectorXd expected = derivative_at_zero(residual_at, 1e-1);
    EXPECT_LE(relative_difference(Eigen::VectorXd(matrix * along), expected), 1e-6)
        << static_cast<int>(formulation.constraints);
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, EquationsOfAStep, testing::Range(0, sample_count), sample_name);

/// Accelerations and multipliers go on linearly from those of the step before, but no further ahead
/// than is known behind; positions and velocities belong to the accelerations by the scheme.
TEST(Predictor, GoesOnAlongAStraightLine) {
  Model model = all_samples()[0].build();
  Mechanism& mechanism = model.mechanism;
  const Scheme scheme = make_scheme(alpha, 2e-3, 0.8);
  StepEquations equations(mechanism, scheme, index_3);
  StepState older = equations.make_state(random_state(model, 3));
  StepState old = equations.make_state(random_state(model, 4));
  older.time = 0.0;
  old.time = 4e-3;
  old.w = 0.9 * old.a;

  Predictor predictor(equations);
  predictor.record(older, old);
  equations.begin(old);
  StepState state = old;
  predictor.predict(old, 6e-3, scheme, equations, state);

  const Eigen::VectorXd a = old.a + 0.5 * (old.a - older.a);
  const Eigen::VectorXd lambda = old.lambda + 0.5 * (old.lambda - older.lambda);
  EXPECT_LE((state.a - a).norm(), 1e-13 * a.norm());
  EXPECT_LE((state.lambda - lambda).norm(), 1e-13 * lambda.norm());
  EXPECT_DOUBLE_EQ(state.time, 6e-3);
  // Chung & Hulbert's equations, written out.
  const double m = (2 * 0.8 - 1) / 1.8, f = 0.8 / 1.8, h = 2e-3;
  const double gamma = 0.5 + f - m, beta = 0.25 * (gamma + 0.5) * (gamma + 0.5);
  const Eigen::VectorXd w = ((1 - f) * a + f * old.a - m * old.w) / (1 - m);
  const Eigen::VectorXd v = old.v + h * ((1 - gamma) * old.w + gamma * w);
  const Eigen::VectorXd increment = h * old.v + h * h * ((0.5 - beta) * old.w + beta * w);
  EXPECT_LE((state.w - w).norm(), 1e-12 * w.norm());
  EXPECT_LE((state.v - v).norm(), 1e-12 * v.norm());
  EXPECT_LE((state.increment - increment).norm(), 1e-12 * increment.norm());
  Eigen::VectorXd q(old.q.size());
  advance(mechanism.rotations, old.q, increment, q);
  EXPECT_LE((state.q - q).norm(), 1e-12 * q.norm());

  older.time = 3e-3;  // the step to come is twice as long as the last one
  predictor.record(older, old);
  predictor.predict(old, 6e-3, scheme, equations, state);
  EXPECT_LE((state.a - (2.0 * old.a - older.a)).norm(), 1e-13 * a.norm());
  predictor.forget();
  predictor.predict(old, 6e-3, scheme, equations, state);
  EXPECT_LE((state.a - old.a).norm(), 1e-13 * a.norm());
  EXPECT_EQ(state.lambda, old.lambda);
}

/// Steps of 100 µs; from the accelerations of the step before they took 1.8 iterations each.
TEST(Predictor, LetsCoarseStepsNeedFewerIterations) {
  const ProblemFile problem = read_problem(source_folder() + "/problems/slider_crank_exudyn.json",
                                           {"/simulation/step=1e-4"})
                                  .complete();
  const auto analysis = analyze(problem, Eigen::VectorXd());
  EXPECT_EQ(analysis->trajectory.steps(), 1500);
  EXPECT_LE(analysis->trajectory.newton_iterations, 1.2 * 1500);
}

/// A point mass that keeps its distance of 2 m from the origin.
Model held_mass() {
  Scene scene;
  scene.bodies = {{"mass", PointMass{{1.2, 1.6, 0.0}, 3.0}}};
  Joint string;
  string.name = "string";
  string.type = JointType::distance;
  string.bodies = {ground_name, "mass"};
  string.at = {0.0, 0.0, 0.0};
  string.to = {1.2, 1.6, 0.0};
  scene.joints = {string};
  return build_model(scene, {.spatial_motion = EffectChoice::on}, {}, {});
}

/// All directions weigh alike: the closest point of the sphere lies on the ray through the mass, and
/// of the velocity its radial part goes.
TEST(Projection, IsRadialForAPointMassOnASphere) {
  Model model = held_mass();
  ASSERT_EQ(model.mechanism.system->coordinates(), 3);
  Projection projection(model.mechanism);
  State state(3, 1);
  state.q = model.mechanism.guess.q;
  const Eigen::Vector3d origin = Eigen::Vector3d(1.2, 1.6, 0.0) - state.q;  // of the coordinates
  const Eigen::Vector3d drifted(1.3, 1.5, 0.1), velocity(-0.7, 2.0, 0.4);
  state.q = drifted - origin;
  state.v = velocity;
  ASSERT_TRUE(projection.apply(state));
  const Eigen::Vector3d expected = 2.0 * drifted.normalized();
  EXPECT_LE((state.q + origin - expected).norm(), 1e-12);
  const Eigen::Vector3d radial = expected.normalized();
  EXPECT_LE((state.v - (velocity - velocity.dot(radial) * radial)).norm(), 1e-12);
}

TEST(Projection, LeavesAStateThatMeetsTheConstraints) {
  for (const SampleScene& sample : all_samples()) {
    Model model = sample.build();
    const State start = initial_state(model.mechanism).state;
    State state = start;
    ASSERT_TRUE(Projection(model.mechanism).apply(state)) << sample.name;
    const Eigen::VectorXd& scale = model.mechanism.scale;
    EXPECT_LE((state.q - start.q).cwiseQuotient(scale).lpNorm<Eigen::Infinity>(), 1e-11)
        << sample.name;
    EXPECT_LE((state.v - start.v).cwiseQuotient(scale).lpNorm<Eigen::Infinity>(),
              1e-10 * (1.0 + start.v.lpNorm<Eigen::Infinity>()))
        << sample.name;
  }
}

/// Two coordinates with scales of 1 and 10; ten regular steps of 0.1 s, at least an eighth of them.
class ControlOfTheLocalError : public testing::Test {
 protected:
  ControlOfTheLocalError() : control_(mechanism(), options()) {}

  const Mechanism& mechanism() {
    mechanism_.scale = Eigen::Vector2d(1.0, 10.0);
    return mechanism_;
  }
  static SimulationOptions options() {
    SimulationOptions options{1.0, 0.1};
    options.local_error = 1e-3;
    options.smallest_step = 0.0125;
    return options;
  }
  static State with_acceleration(double first, double second) {
    State state(2, 0);
    state.a = Eigen::Vector2d(first, second);
    return state;
  }

  Mechanism mechanism_;
  LocalErrorControl control_;
};

TEST_F(ControlOfTheLocalError, HalvesDownToTheSmallestStep) {
  EXPECT_EQ(control_.parts(), 8);
  EXPECT_EQ(control_.end_of_part(0), 8);
  for (const int end : {4, 2, 1}) {
    ASSERT_TRUE(control_.refine());
    EXPECT_EQ(control_.end_of_part(0), end);
  }
  EXPECT_FALSE(control_.refine());
}

/// A part of four eighths cannot begin at one of them.
TEST_F(ControlOfTheLocalError, BeginsPartsAtMultiplesOfTheirSize) {
  EXPECT_EQ(control_.end_of_part(4), 8);
  EXPECT_EQ(control_.end_of_part(6), 8);
  EXPECT_EQ(control_.end_of_part(7), 8);
  EXPECT_EQ(control_.level(), 3);
}

TEST_F(ControlOfTheLocalError, TakesLargerPartsAfterSmallErrors) {
  control_.set_level(2);
  control_.accept(0.2);
  EXPECT_EQ(control_.level(), 2);
  control_.accept(0.1);
  EXPECT_EQ(control_.level(), 1);
  control_.accept(0.1);
  control_.accept(0.1);
  EXPECT_EQ(control_.level(), 0);
}

/// c h³ q⃛ with q⃛ = (a⁺ − a)/h in each of the parts, relative to scale and allowance.
TEST_F(ControlOfTheLocalError, MeasuresTheErrorOfARegularStep) {
  Scheme scheme = make_scheme(SchemeType::generalized_alpha, 0.05, 0.8);
  const State old = with_acceleration(1.0, 5.0), found = with_acceleration(1.3, 11.0);
  control_.set_level(1);
  // The scheme's local_error is c h³; the second coordinate's 6/10 is twice the first one's 0.3/1.
  const double expected = 2.0 * std::abs(scheme.local_error) * 0.6 / 0.05 / 1e-3;
  EXPECT_NEAR(control_.relative_error(old, found, scheme), expected, 1e-12 * expected);
  EXPECT_EQ(control_.worst_coordinate(old, found, scheme), 1);
}

constexpr double state_bytes = 800.0, checkpoint_bytes = 1100.0;

class PlanOfCheckpoints : public testing::TestWithParam<int> {};

/// With the least memory: K L states are enough, both halves are kept, and stretches cover all.
TEST_P(PlanOfCheckpoints, HoldsSoManyStatesWithTheLeastMemory) {
  const int states = GetParam();
  CheckpointPlan plan{state_bytes, checkpoint_bytes, 0.0};
  plan.memory = plan.least_memory(states);
  EXPECT_GE(plan.most_states(), states);
  EXPECT_LE(plan.most_checkpoints() * checkpoint_bytes, 0.5 * plan.memory);
  EXPECT_LE((plan.longest_stretch() + 1) * state_bytes, 0.5 * plan.memory);
  const int stretch = plan.stretch_for(states);
  EXPECT_LE(stretch, plan.longest_stretch());
  EXPECT_GE(static_cast<double>(stretch) * plan.most_checkpoints(), states);
}

/// Two halves of memory M hold K L = (M/2c)(M/2s) states: M = 2 √(states s c) at least.
TEST_P(PlanOfCheckpoints, NeedsTheRootOfTheStates) {
  const int states = GetParam();
  CheckpointPlan plan{state_bytes, checkpoint_bytes, 0.0};
  plan.memory = 2.0 * std::sqrt(states * state_bytes * checkpoint_bytes) * (1 - 1e-12);
  EXPECT_LT(plan.most_states(), states);
}

INSTANTIATE_TEST_SUITE_P(States, PlanOfCheckpoints,
                         testing::Values(2, 3, 10, 1000, 123'457, 20'000'000), named_by_value());

TEST(CheckpointPlan, HoldsAllStatesWhereTheyFit) {
  const CheckpointPlan plan{state_bytes, checkpoint_bytes, 8000.0};
  EXPECT_TRUE(plan.holds(10));
  EXPECT_FALSE(plan.holds(11));
}

TEST(CheckpointPlan, HasNoCheckpointsWithoutMemory) {
  const CheckpointPlan plan{state_bytes, checkpoint_bytes, 100.0};
  EXPECT_EQ(plan.most_checkpoints(), 0);
  EXPECT_EQ(plan.longest_stretch(), 0);
  EXPECT_EQ(plan.most_states(), 0);
}

/// The tip of a bent bar on a hinge with a spring, with a mass at its tip, over its length L, in
/// equilibrium with its loads. Materials stay, times go with L, accelerations with 1/L.
double tip_over_length(double length) {
  const double area = length * length, volume = area * length;
  const ProblemFile problem = problem_from(
      fmt::format(R"j({{"scene": {{"gravity": [0, {:.17g}, 0],
    "bodies": {{
      "bar": {{"type": "beam", "from": [0, 0, 0], "to": [{:.17g}, 0, 0], "material": "steel", "elements": 3,
        "frame": "chord", "section": {{"type": "rectangle", "width": {:.17g}, "height": {:.17g}}}}},
      "end": {{"type": "rigid", "at": [{:.17g}, 0, 0], "mass": {:.17g}, "inertia": [{:.17g}, {:.17g}, {:.17g}, 0, 0, 0]}}}},
    "joints": {{
      "hinge": {{"type": "revolute", "bodies": ["ground", "bar"], "at": [0, 0, 0]}},
      "weld": {{"type": "fixed", "bodies": ["bar", "end"], "at": [{:.17g}, 0, 0]}}}},
    "loads": {{
      "push": {{"type": "force", "body": "bar", "at": [{:.17g}, 0, 0], "direction": [0, 1, 0.3], "value": {:.17g}}},
      "coil": {{"type": "joint", "joint": "hinge", "stiffness": {:.17g}}}}}}},
  "simulation": {{"end_time": {:.17g}, "step": {:.17g}, "initial_state": "quasi-static"}},
  "responses": {{"y": {{"type": "position", "body": "end", "direction": "y", "over_time": "final"}}}}}})j",
                  -9.81 / length, length, 0.01 * length, 0.02 * length, length, 0.5 * volume,
                  1e-3 * volume * area, 1e-3 * volume * area, 1e-3 * volume * area, length,
                  0.5 * length, 20.0 * area, 100.0 * volume, 2e-4 * length, 1e-4 * length));
  return values_of(*analyze(problem, start_design(problem)))(0) / length;
}

/// From a centimetre to 100 m: forces and weights of the assembly are then up to 10¹³ apart. (The start
/// of free frames is less exact the larger they are: 1e-7 at 100 m.)
TEST(SizeOfAMechanism, DoesNotMatterToItsEquilibrium) {
  const double metre = tip_over_length(1.0);
  EXPECT_NEAR(tip_over_length(0.01), metre, 1e-9 * std::abs(metre));
  EXPECT_NEAR(tip_over_length(10.0), metre, 1e-8 * std::abs(metre));
  EXPECT_NEAR(tip_over_length(100.0), metre, 1e-6 * std::abs(metre));
}

/// Of kilometres it ended in "no elastic equilibrium was found".
TEST(SizeOfAMechanism, MayBeThatOfACity) {
  EXPECT_NEAR(tip_over_length(1000.0), tip_over_length(1.0), 2e-3 * std::abs(tip_over_length(1.0)));
}

// Machines that stand on springs and are shaken by a mass that turns in them.

/// 10 kg on a post of 300 mm, with 0.5 kg on a shaft 50 mm beside its centre, in space.
ProblemFile shaken_post(double revolutions_per_minute) {
  return problem_from(fmt::format(R"j({{"scene": {{"gravity": [0, 0, 0], "bodies": {{
      "post": {{"type": "beam", "from": [0, 0, 0], "to": [0, 0.3, 0], "material": "steel", "elements": 4,
        "section": {{"type": "rectangle", "width": "40 mm", "height": "6 mm"}}, "damping": {{"stiffness": "0.5 ms"}}}},
      "machine": {{"type": "rigid", "at": [0, 0.35, 0], "mass": 10, "inertia": [0.1, 0.1, 0.1, 0, 0, 0]}},
      "unbalance": {{"type": "rigid", "at": [0.05, 0.35, 0], "mass": 0.5, "inertia": [1e-3, 1e-3, 1e-3, 0, 0, 0]}}}},
    "joints": {{
      "foot": {{"type": "fixed", "bodies": ["ground", "post"], "at": [0, 0, 0]}},
      "top": {{"type": "fixed", "bodies": ["post", "machine"], "at": [0, 0.3, 0]}},
      "motor": {{"type": "revolute", "bodies": ["machine", "unbalance"], "at": [0, 0.35, 0], "axis": [0, 0, 1],
                 "drive": {{"type": "constant-speed", "speed": "{} rpm"}}}}}}}},
  "effects": {{"spatial_motion": "on"}},
  "simulation": {{"end_time": 0.002, "step": 0.001, "initial_state": "quasi-static"}},
  "responses": {{"sway": {{"type": "position", "body": "machine", "direction": "x", "over_time": "max"}}}}}})j",
                                  revolutions_per_minute));
}

/// The lowest frequency is 4.7 Hz, 280 rpm. Above it a shaft would have to be held by gyroscopic forces;
/// the post does not turn. The force of the turning mass grows with the square of the speed, and the
/// sway with it.
TEST(UnbalancedMachine, DoesNotBuckleAboveItsResonance) {
  const auto sway = [](double speed) {
    const ProblemFile problem = shaken_post(speed);
    return values_of(*analyze(problem, start_design(problem)))(0);
  };
  EXPECT_NEAR(sway(600.0) / sway(200.0), 9.0, 0.05);
}

}  // namespace
}  // namespace pleuel::test::step_test
