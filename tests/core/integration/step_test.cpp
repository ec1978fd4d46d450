#include "core/base/eager_matrices.hpp"
#include "core/integration/projection.hpp"
#include "core/integration/step_equations.hpp"
#include "core/integration/time_loop.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/model/model.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"
#include "core/start/initial_state.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/random_state.hpp"
#include "tests/support/sample_name.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/scheme_case.hpp"
#include "tests/support/source_folder.hpp"
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

}  // namespace
}  // namespace pleuel::test::step_test
