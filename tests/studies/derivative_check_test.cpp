#include "studies/derivative_check.hpp"

#include <gtest/gtest.h>

#include "tests/studies/quick_problem.hpp"

namespace pleuel {
namespace {

TEST(DerivativeCheck, AgreesForEveryResponseOfASampleProblem) {
  const ProblemFile problem = test::quick_problem();
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const auto checks = check_derivatives(problem, x, *analysis, [](double) {});
  ASSERT_EQ(checks.size(), problem.responses.size());
  for (std::size_t i = 0; i < checks.size(); ++i) {
    // Differences of simulations with round-off 1e-12 reach 1e-8; what `check` allows is 1e-6.
    EXPECT_LT(checks[i].error, 1e-6) << problem.responses[i].name;
  }
}

TEST(DerivativeCheck, NoticesThatAnalysisAndDesignDoNotBelongTogether) {
  const ProblemFile problem = test::quick_problem();
  const Eigen::VectorXd x = start_design(problem);
  const auto elsewhere = analyze(problem, 1.01 * x);
  const auto checks = check_derivatives(problem, x, *elsewhere, [](double) {});
  // The mass grows with the square of the diameter: its gradient is 1 % off.
  EXPECT_NEAR(checks.front().error, 0.01, 1e-6);
}

}  // namespace
}  // namespace pleuel
