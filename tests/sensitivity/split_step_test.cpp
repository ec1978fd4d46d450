#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/response/analysis.hpp"
#include "sensitivity/direct.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/sample_scenes.hpp"

namespace pleuel::test::split_step_test {
namespace {

/// Too few iterations for such steps, so that some are split.
SimulationOptions impatient() {
  SimulationOptions options{0.06, 5e-3, 0.8};
  options.newton_tolerance = 1e-12;
  options.max_newton_iterations = 4;
  return options;
}

/// A step that fails is halved until it works, and the instants that were asked for are met.
TEST(SplitSteps, LeadToEveryRegularInstant) {
  Model model = smooth_planar_sample().build();
  const SimulationOptions options = impatient();
  const Trajectory trajectory = simulate(model.mechanism, options);
  ASSERT_GT(trajectory.split_steps, 0);
  EXPECT_EQ(trajectory.steps(), step_count(options) + trajectory.split_steps);
  for (int step = 0; step <= step_count(options); ++step) {
    const double instant = options.end_time * step / step_count(options);
    EXPECT_LE((trajectory.time.array() - instant).abs().minCoeff(), 1e-15) << step;
  }
  SimulationOptions patient = options;
  patient.max_newton_iterations = 20;
  const Trajectory whole = simulate(model.mechanism, patient);
  EXPECT_EQ(whole.split_steps, 0);
  // The same motion up to the error of the large steps.
  const Eigen::VectorXd end = trajectory.columns().q().col(trajectory.steps()),
                        other = whole.columns().q().col(whole.steps());
  EXPECT_LE((end - other).norm(), 0.05 * other.norm());
}

/// The sequence of steps that ran is differentiated.
TEST(SplitSteps, AreDifferentiatedAsTheyRan) {
  const SampleScene sample = smooth_planar_sample();
  Model model = sample.build();
  const Trajectory trajectory = simulate(model.mechanism, impatient());
  ASSERT_GT(trajectory.split_steps, 0);
  Eigen::MatrixXd s;
  differentiate(model.mechanism, trajectory,
                [&](int, const State&, const StateSensitivity& now) { s = now.q; });
  for (std::size_t j = 0; j < sample.design.size(); ++j) {
    const double h = 1e-5 * sample.design[j];
    const auto end_at = [&](double change) -> Eigen::VectorXd {
      auto design = sample.design;
      design[j] += change;
      Model neighbour = sample.build_at(design);
      const Trajectory found = simulate(neighbour.mechanism, impatient());
      EXPECT_EQ(found.steps(), trajectory.steps()) << "not the same sequence of steps";
      return found.columns().q().col(found.steps());
    };
    const Eigen::VectorXd expected = (end_at(h) - end_at(-h)) / (2 * h);
    const Eigen::VectorXd found = s.col(j);
    EXPECT_LE((found - expected).lpNorm<Eigen::Infinity>(),
              1e-5 * found.lpNorm<Eigen::Infinity>() + 1e-9)
        << sample.variables[j];
  }
}

/// A mechanism in motion sets out with velocities that belong to the size of the first step. Where
/// that fails, the halves have to set out from the initial values, not from where it did.
TEST(SplitSteps, OfTheFirstStepSetOutFromTheInitialValues) {
  const ProblemFile problem =
      sample_problem("hard/dead_centres", {"/simulation/step=16 ms", "/simulation/end_time=64 ms",
                                           "/simulation/max_newton_iterations=4"});
  const Eigen::VectorXd x = start_design(problem);
  const auto split = analyze(problem, x);
  ASSERT_LT(split->trajectory.time(1), 0.01) << "the first step was to be split";
  ProblemFile patient = with_steps_of(split->trajectory, problem);
  patient.simulation.instants.assign(split->trajectory.time.begin(), split->trajectory.time.end());
  patient.simulation.max_newton_iterations = 20;
  const auto whole = analyze(patient, x);
  ASSERT_EQ(whole->trajectory.split_steps, 0);
  ASSERT_EQ(whole->trajectory.steps(), split->trajectory.steps());
  State found, expected;
  for (int step = 0; step <= split->trajectory.steps(); ++step) {
    split->trajectory.states->load(step, found);
    whole->trajectory.states->load(step, expected);
    // What Newton's method leaves, 1e-10, in another number of iterations.
    EXPECT_LE((found.v - expected.v).norm(), 1e-7 * expected.v.norm()) << step;
  }
}

}  // namespace
}  // namespace pleuel::test::split_step_test
