#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/response/history_reduction.hpp"
#include "core/scene/problem_reader.hpp"
#include "core/trust/checks.hpp"
#include "core/trust/error_bars.hpp"
#include "tests/support/source_folder.hpp"

/// Bands around histories against runs at an eighth of the step with four times the elements.
namespace pleuel::test::error_bands_test {
namespace {

/// Errors of vibrations pass through zero; instants.
constexpr Eigen::Index nearby = 5;

struct Coverage {
  double covered = 0.0;  ///< share of instants
  /// Median of the band over the largest error nearby, of errors above a thousandth of the history.
  double ratio = 0.0;
};

/// Of all histories of a problem.
Coverage coverage(const std::string& name, const std::vector<std::string>& overrides) {
  const ProblemFile problem =
      read_problem(source_folder() + "/problems/" + name + ".json", overrides).complete();
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const Monitors monitors = monitor(analysis->model, analysis->trajectory);
  const std::vector<Eigen::VectorXd> bands =
      judge_run(TrustedRun{problem, x, *analysis, monitors}).bands;
  const RefinedRun exact = make_refined_run(problem, x, {0.125, 4.0});
  EXPECT_EQ(exact.time.size(), 8 * (analysis->trajectory.time.size() - 1) + 1);
  double covered = 0.0, instants = 0.0;
  std::vector<double> ratios;
  for (std::size_t i = 0; i < bands.size(); ++i) {
    if (analysis->histories[i].size() == 0) continue;
    const Response& response = analysis->responses[i];
    const Eigen::VectorXd here = shown_history(response, analysis->histories[i]);
    const Eigen::VectorXd there = shown_history(response, exact.histories[i]);
    const double largest = here.cwiseAbs().maxCoeff();
    EXPECT_EQ(bands[i].size(), here.size()) << response.name;
    Eigen::VectorXd error(here.size());
    for (Eigen::Index k = 0; k < error.size(); ++k) error(k) = std::abs(there(8 * k) - here(k));
    for (Eigen::Index k = 0; k < error.size(); ++k) {
      instants += 1.0;
      if (error(k) <= bands[i](k) + 1e-9 * largest) covered += 1.0;
      const Eigen::Index first = std::max<Eigen::Index>(k - nearby, 0);
      const Eigen::Index last = std::min(k + nearby, error.size() - 1);
      const double around = error.segment(first, last - first + 1).maxCoeff();
      if (around > 1e-3 * largest) ratios.push_back(bands[i](k) / around);
    }
  }
  if (ratios.empty()) return {covered / instants, 1.0};
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return {covered / instants, *middle};
}

TEST(ErrorBands, HoldTheTrueHistories) {
  const auto check = [](const std::string& name, const std::vector<std::string>& overrides) {
    const Coverage found = coverage(name, overrides);
    EXPECT_GE(found.covered, 0.95) << name << overrides.front();
    EXPECT_LE(found.ratio, 5.0) << name << overrides.front();
    testing::Test::RecordProperty(name, std::to_string(found.covered));
  };
  check("slider_crank_round", {"/simulation/step=0.1 ms"});
  check("slider_crank_round", {"/simulation/step=0.4 ms"});
  check("four_bar", {"/simulation/step=0.5 ms"});
  check("robot_arm", {"/simulation/step=1 ms"});
  check("spatial_slider_crank", {"/simulation/step=0.4 ms", "/scene/bodies/rod/elements=2"});
}

TEST(ErrorBands, AreNotMadeWhereNothingIsChecked) {
  const ProblemFile problem =
      read_problem(source_folder() + "/problems/robot_arm.json",
                   {"/simulation/step=4 ms", "/simulation/resolution_check=false"})
          .complete();
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const Monitors monitors = monitor(analysis->model, analysis->trajectory);
  EXPECT_THAT(judge_run(TrustedRun{problem, x, *analysis, monitors}).bands, testing::IsEmpty());
}

}  // namespace
}  // namespace pleuel::test::error_bands_test
