#include "studies/accuracy_optimum.hpp"

#include <gmock/gmock.h>

#include "core/base/eager_matrices.hpp"
#include "tests/studies/quick_problem.hpp"

namespace pleuel::test::accuracy_optimum_test {
namespace {

AccuracyRun run_of(double step, double seconds, double error) {
  AccuracyRun run;
  run.settings = {step, 4};
  run.simulation_seconds = seconds;
  run.errors = Eigen::VectorXd::Constant(1, error);
  return run;
}

TEST(AccuracyOptimum, TriesWhatIsRecommendedAndThanWhichNothingIsBetterInBoth) {
  AccuracyStudy study;
  study.counted = {0};
  study.runs = {run_of(1, 1.0, 0.5), run_of(2, 2.0, 0.6), run_of(3, 3.0, 0.1), run_of(4, 5.0, 0.1),
                run_of(5, 4.0, 0.01)};
  study.runs.push_back(run_of(6, 0.1, 0.0));
  study.runs.back().failure = "it stopped";
  study.recommendations = {{0.6, 1, {}}};
  std::vector<double> steps;
  for (const Discretization& one : efficient_settings(study)) steps.push_back(one.step);
  EXPECT_THAT(steps, testing::ElementsAre(1.0, 2.0, 3.0, 5.0));
}

/// The error of the reference is an estimate: checked against an optimum with half its step and
/// twice its elements.
TEST(AccuracyOptimum, KnowsHowFarItsReferenceIsOff) {
  ProblemFile problem = test::quick_problem();
  problem.accuracy = test::grid({4e-4}, {2}, 1e-2);
  const SolveOptions options{.backend = "nlopt-mma"};
  const Eigen::VectorXd x = plain_optimum(problem, options).x;
  const AccuracyStudy study = accuracy_study(problem, {problem, x});
  const OptimumStudy optima = optimum_study(problem, x, study, options);
  ASSERT_FALSE(optima.reference.has_failed()) << optima.reference.failure;
  ASSERT_TRUE(optima.reference_error);
  const Discretization finer = finer_than(problem, {study.reference.settings});
  const Result better = plain_optimum(discretized(problem, finer), options);
  const double error = std::abs(better.evaluation.objective - optima.reference.objective);
  EXPECT_LE(error, 2.0 * *optima.reference_error);
  EXPECT_GE(error, 0.1 * *optima.reference_error);
  ASSERT_EQ(optima.runs.size(), 1u);
  const OptimumRun& run = optima.runs.front();
  EXPECT_EQ(run.change, run.objective - optima.reference.objective);
  EXPECT_GE(optima.relative_error(run), optima.relative_floor());
  EXPECT_GT(run.seconds, 0.0);
}

}  // namespace
}  // namespace pleuel::test::accuracy_optimum_test
