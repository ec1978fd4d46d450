#include "studies/accuracy.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "core/base/error.hpp"
#include "core/response/analysis.hpp"
#include "tests/studies/quick_problem.hpp"

namespace pleuel {
namespace {

AccuracyStudy study(double error) {
  ProblemFile problem = test::quick_problem();
  problem.accuracy = AccuracySettings{{4e-4, 2e-4, 1e-4}, {4}, error};
  return accuracy_study(problem);
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
  ASSERT_TRUE(result.recommended);
  const AccuracyRun& best = result.runs[*result.recommended];
  EXPECT_LE(best.largest_error(), 0.5);
  for (const AccuracyRun& run : result.runs) {
    if (run.largest_error() > 0.5) continue;
    EXPECT_LE(best.seconds(), run.seconds());
  }
}

TEST(Accuracy, RecommendsNothingIfNothingIsGoodEnough) {
  EXPECT_FALSE(study(1e-12).recommended);
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
  problem.accuracy = AccuracySettings{{5e-3, 1e-4}, {2}, 1e-3};
  problem.simulation.newton_tolerance = 1e-9;
  const AccuracyStudy result = accuracy_study(problem);
  EXPECT_FALSE(result.runs[0].failure.empty());
  EXPECT_TRUE(result.runs[1].failure.empty()) << result.runs[1].failure;
}

TEST(Accuracy, WithoutSettingsThereIsNothingToTry) {
  ProblemFile problem = test::quick_problem();
  problem.accuracy.reset();
  EXPECT_THROW(accuracy_study(problem), InputError);
}

}  // namespace
}  // namespace pleuel
