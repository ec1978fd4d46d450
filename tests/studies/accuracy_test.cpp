#include "studies/accuracy.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/analysis.hpp"
#include "tests/studies/quick_problem.hpp"

namespace pleuel::test::accuracy_test {
namespace {

PricedDesign at_start(const ProblemFile& problem) {
  return {problem, start_design(problem)};
}

AccuracyStudy study(double target) {
  ProblemFile problem = test::quick_problem();
  problem.accuracy = test::grid({4e-4, 2e-4, 1e-4}, {4}, target);
  return accuracy_study(problem, at_start(problem));
}

/// Of the responses that are minimized or limited.
double counted_error(const AccuracyStudy& study, const AccuracyRun& run) {
  double largest = 0.0;
  for (const std::size_t i : study.counted) {
    largest = std::max(largest, run.errors(i));
  }
  return largest;
}

TEST(Accuracy, ErrorsFallWithTheStepAsASecondOrderSchemeMust) {
  const AccuracyStudy result = study(1e-3);
  ASSERT_EQ(result.runs.size(), 3u);
  Eigen::Index torque = 6;  // torque_rms: smooth in the step, unlike a maximum
  const double coarse = result.runs[0].errors(torque), fine = result.runs[2].errors(torque);
  // Halved twice: a factor 16 at least if the reference (half the finest) were exact, 21 as it is,
  // until round-off and the elements take over; first order would give 4.
  EXPECT_GT(coarse / fine, 8.0) << coarse << " → " << fine;
}

TEST(Accuracy, GradientsConvergeToo) {
  const AccuracyStudy result = study(1e-3);
  EXPECT_LT(result.runs[2].gradient_errors.maxCoeff(), result.runs[0].gradient_errors.maxCoeff());
}

TEST(Accuracy, TheMassDependsOnNoStep) {
  for (const AccuracyRun& run : study(1e-3).runs) EXPECT_LT(run.errors(0), 1e-12);
}

TEST(Accuracy, RecommendsTheFastestOfThoseThatAreGoodEnough) {
  const AccuracyStudy result = study(0.5);
  ASSERT_EQ(result.recommendations.size(), 3u);
  double target = 0.5;
  for (const Recommendation& one : result.recommendations) {
    EXPECT_NEAR(one.target, target, 1e-12);
    target *= 0.1;
    for (const AccuracyRun& run : result.runs) {
      if (counted_error(result, run) > one.target) continue;
      ASSERT_TRUE(one.values);
      EXPECT_LE(result.runs[*one.values].simulation_seconds, run.simulation_seconds);
    }
    if (!one.values) continue;
    EXPECT_LE(counted_error(result, result.runs[*one.values]), one.target);
  }
  EXPECT_TRUE(result.recommendations.front().values);
}

TEST(Accuracy, RecommendsNothingIfNothingIsGoodEnough) {
  for (const Recommendation& one : study(1e-12).recommendations) {
    EXPECT_FALSE(one.values);
    EXPECT_FALSE(one.gradients);
  }
}

/// Responses that nobody limits have no veto: the end position of the slider, say.
TEST(Accuracy, CountsWhatIsMinimizedOrLimited) {
  const ProblemFile problem = test::quick_problem();
  const AccuracyStudy result = study(1e-2);
  ASSERT_EQ(result.counted.size(), problem.constraints.size() + 1);
  for (const std::size_t i : result.counted) {
    const std::string& name = problem.responses[i].name;
    EXPECT_TRUE(name == problem.objective->response ||
                std::any_of(problem.constraints.begin(), problem.constraints.end(),
                            [&](const auto& limit) { return limit.response == name; }))
        << name;
  }
}

TEST(Accuracy, TriesStepsAndElementsAroundThoseOfTheFileIfItNamesNone) {
  ProblemFile problem = test::quick_problem();
  problem.accuracy = {};
  const std::vector<Discretization> grid = accuracy_grid(problem);
  EXPECT_EQ(grid.size(), 12u);
  const AccuracyStudy result = accuracy_study(problem, at_start(problem));
  EXPECT_EQ(result.runs.size(), 12u);
  EXPECT_DOUBLE_EQ(result.reference.settings.step, problem.simulation.step / 4);
  EXPECT_DOUBLE_EQ(result.reference.settings.factor, 4.0);
}

TEST(Accuracy, IsThatOfTheDesignThatIsAskedFor) {
  ProblemFile problem = test::quick_problem();
  problem.accuracy = test::grid({2e-4}, {2}, 1e-2);
  const Eigen::VectorXd x = 0.7 * start_design(problem);
  const AccuracyStudy result = accuracy_study(problem, {problem, x});
  const ProblemFile same = discretized(problem, result.runs[0].settings);
  EXPECT_EQ(result.runs[0].values, values_of(*analyze(same, x)));
}

TEST(Accuracy, ReferenceIsFinerThanEveryRun) {
  const AccuracyStudy result = study(1e-3);
  EXPECT_DOUBLE_EQ(result.reference.settings.step, 0.5e-4);
  EXPECT_EQ(result.reference.settings.elements, 8);
}

/// Against a run with a quarter of its step and twice its elements, which is nearly exact beside
/// it.
TEST(Accuracy, EstimatesTheErrorOfItsReference) {
  const AccuracyStudy result = study(1e-3);
  ProblemFile finer = test::quick_problem();
  finer.simulation.step = result.reference.settings.step / 4;
  for (Body& body : finer.scene.bodies) {
    auto* beam = std::get_if<BeamBody>(&body.shape);
    if (beam) beam->segments.front().elements = 2 * result.reference.settings.elements;
  }
  const Eigen::VectorXd exact = values_of(*analyze(finer, start_design(finer)));
  const Eigen::Index torque = 6;  // torque_rms: smooth in the step, unlike a maximum
  const double error = std::abs(result.reference.values(torque) / exact(torque) - 1.0);
  EXPECT_GT(result.reference.errors(torque), 0.5 * error);
  EXPECT_LT(result.reference.errors(torque), 2.0 * error);
}

TEST(Accuracy, SaysNoErrorBelowThatOfItsReference) {
  const AccuracyStudy result = study(1e-3);
  for (const AccuracyRun& run : result.runs) {
    EXPECT_GE((run.errors - result.reference.errors).minCoeff(), 0.0);
    EXPECT_GE((run.gradient_errors - result.reference.gradient_errors).minCoeff(), 0.0);
  }
  EXPECT_GT(result.reference.errors.maxCoeff(), 0.0);
}

TEST(Accuracy, AFailingRunIsMarkedAndTheOthersGoOn) {
  ProblemFile problem = test::quick_problem({"/simulation/max_newton_iterations=2"});
  problem.accuracy = test::grid({5e-3, 1e-4}, {2}, 1e-3);
  problem.simulation.newton_tolerance = 1e-9;
  const AccuracyStudy result = accuracy_study(problem, at_start(problem));
  EXPECT_FALSE(result.runs[0].failure.empty());
  EXPECT_TRUE(result.runs[1].failure.empty()) << result.runs[1].failure;
}

TEST(Accuracy, WithoutResponsesThereIsNothingToCompare) {
  ProblemFile problem = test::quick_problem();
  problem.responses.clear();
  EXPECT_THROW(accuracy_study(problem, at_start(problem)), InputError);
}

}  // namespace
}  // namespace pleuel::test::accuracy_test
