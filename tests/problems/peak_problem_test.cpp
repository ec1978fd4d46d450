#include "optimization/design/peak_problem.hpp"

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/scene/problem_reader.hpp"
#include "optimization/design/design_solve.hpp"
#include "tests/support/source_folder.hpp"

namespace pleuel::test::peak_problem_test {
namespace {

/// A quick variant of a problem file: coarse, and over in 20 ms.
ProblemFile quick_problem(const char* name) {
  const auto path =
      std::filesystem::path(source_folder()) / "problems" / (std::string(name) + ".json");
  return read_problem(path, {"/simulation/step=0.2 ms", "/simulation/end_time=20 ms",
                             "/scene/joints/bearing/drive/ramp=20 ms"})
      .complete();
}

TEST(PeakProblem, FoldsToTheConstraintsOfTheFile) {
  DesignProblem problem(quick_problem("slider_crank"));
  PeakProblem peaks(problem, 16);
  const Eigen::VectorXd x = start_design(problem.file());
  const Evaluation whole = problem.evaluate(x, Request::values);
  const Evaluation rows = peaks.evaluate(x, Request::values);
  EXPECT_GT(rows.constraints.size(), whole.constraints.size());
  const Eigen::VectorXd folded = peaks.fold_values(rows.constraints);
  for (Eigen::Index i = 0; i < folded.size(); ++i) {
    EXPECT_EQ(folded(i), whole.constraints(i)) << problem.constraints()[std::size_t(i)].name;
  }
}

/// The gradient of a whole maximum is that of its highest window.
TEST(PeakProblem, HasTheGradientOfTheWholeInItsWorstRow) {
  DesignProblem problem(quick_problem("slider_crank_round"));
  PeakProblem peaks(problem, 16);
  const Eigen::VectorXd x = 0.8 * start_design(problem.file());
  const Evaluation whole = problem.evaluate(x, Request::values_and_gradients);
  const Evaluation rows = peaks.evaluate(x, Request::values_and_gradients);
  const auto& constraint_of_row = peaks.constraint_of_row();
  Eigen::Index first = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto count =
        Eigen::Index(std::count(constraint_of_row.begin(), constraint_of_row.end(), i));
    Eigen::Index worst = 0;
    rows.constraints.segment(first, count).maxCoeff(&worst);
    EXPECT_EQ(rows.constraint_jacobian.row(first + worst),
              whole.constraint_jacobian.row(Eigen::Index(i)));
    first += count;
  }
  EXPECT_EQ(first, rows.constraints.size()) << "all four limits are on peaks";
}

/// Differences of each window's peak: those of the exact method, to their truncation.
TEST(PeakProblem, HasTheGradientsOfDifferencesIfAsked) {
  ProblemFile file = quick_problem("slider_crank_round");
  DesignProblem exact(file);
  file.sensitivity.method = GradientMethod::central_difference;
  DesignProblem differenced(file, 2);
  PeakProblem peaks(exact, 16), differenced_peaks(differenced, 16);
  const Eigen::VectorXd x = 0.8 * start_design(file);
  const Evaluation expected = peaks.evaluate(x, Request::values_and_gradients);
  const Evaluation found = differenced_peaks.evaluate(x, Request::values_and_gradients);
  EXPECT_EQ(differenced.method()->method, GradientMethod::central_difference);
  EXPECT_EQ(found.constraints, expected.constraints);
  const auto compare = [](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    EXPECT_LE((a - b).lpNorm<Eigen::Infinity>(), 1e-5 * b.lpNorm<Eigen::Infinity>());
    EXPECT_GT((a - b).lpNorm<Eigen::Infinity>(), 0.0);
  };
  compare(found.constraint_jacobian, expected.constraint_jacobian);
  compare(found.objective_gradient, expected.objective_gradient);
}

TEST(PeakProblem, AddsTheMultipliersOfTheRowsOfAConstraint) {
  DesignProblem problem(quick_problem("slider_crank_round"));
  PeakProblem peaks(problem, 16);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(Eigen::Index(peaks.constraints().size()));
  // 16 windows; of the stress of one segment, at four stretches of it.
  EXPECT_EQ(peaks.fold_multipliers(ones), Eigen::Vector4d(64.0, 64.0, 16.0, 16.0));
}

/// Sixteen rows for each limit from the beginning mislead SLSQP here into an infeasible design.
TEST(SolveDesign, SplitsNoLimitsWhereTheOptimumIsSmooth) {
  DesignProblem problem(quick_problem("slider_crank_round"));
  const Result result = solve_design(problem, {.backend = "nlopt-slsqp"});
  EXPECT_EQ(to_string(result.status), "verified") << result.message;
  EXPECT_EQ(result.restarts, 0);
}

}  // namespace
}  // namespace pleuel::test::peak_problem_test
