#include "core/integration/predictor.hpp"

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/mechanism/configuration.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"
#include "tests/support/random_state.hpp"
#include "tests/support/sample_name.hpp"
#include "tests/support/scheme_case.hpp"
#include "tests/support/source_folder.hpp"

namespace pleuel::test::predictor_test {
namespace {

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

}  // namespace
}  // namespace pleuel::test::predictor_test
