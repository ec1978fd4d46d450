#include "studies/method_comparison.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "tests/studies/quick_problem.hpp"

namespace pleuel::test::method_comparison_test {
namespace {

class MethodComparison : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const ProblemFile problem = test::quick_problem();
    const Eigen::VectorXd x = start_design(problem);
    const auto analysis = analyze(problem, x);
    compared_ = compare_methods(problem, x, *analysis);
  }

  static std::vector<double> errors_of(GradientMethod method, std::size_t response) {
    std::vector<double> errors;
    for (const ComparedMethod& one : compared_) {
      if (one.method == method) errors.push_back(one.errors(response));
    }
    return errors;
  }

  static std::vector<ComparedMethod> compared_;
};

std::vector<ComparedMethod> MethodComparison::compared_;

TEST_F(MethodComparison, FindsTheExactMethodsTheSameUpToRoundOff) {
  for (const GradientMethod method : {GradientMethod::direct, GradientMethod::adjoint}) {
    const auto found = std::find_if(compared_.begin(), compared_.end(),
                                    [&](const auto& one) { return one.method == method; });
    ASSERT_NE(found, compared_.end());
    EXPECT_EQ(found->step, 0.0);
    EXPECT_GT(found->seconds, 0.0);
    EXPECT_LT(found->errors.maxCoeff(), 1e-10);
  }
}

/// Taylor: the error of a forward difference is h f''/2, that of a central one h² f'''/6; from a
/// step of 1e-2 to one of 1e-3 they fall by 10 and 100 where a response is curved.
TEST_F(MethodComparison, SeesTheOrdersOfDifferencesWhereStepsAreLarge) {
  int curved = 0;
  for (Eigen::Index i = 0; i < compared_.front().errors.size(); ++i) {
    const auto response = static_cast<std::size_t>(i);
    const auto forward = errors_of(GradientMethod::forward_difference, response);
    const auto central = errors_of(GradientMethod::central_difference, response);
    ASSERT_EQ(forward.size(), 7u);
    ASSERT_EQ(central.size(), 7u);
    if (!(forward[0] > 1e-3 && central[0] > 1e-5 && central[0] < 0.1)) continue;
    EXPECT_NEAR(std::log10(forward[0] / forward[1]), 1.0, 0.15);
    EXPECT_NEAR(std::log10(central[0] / central[1]), 2.0, 0.15);
    ++curved;
  }
  EXPECT_GT(curved, 0);
}

}  // namespace
}  // namespace pleuel::test::method_comparison_test
