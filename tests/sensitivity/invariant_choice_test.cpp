#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/support/problem_runs.hpp"

namespace pleuel::test::invariant_choice_test {
namespace {

/// Relative to the largest derivative of a response by relative changes of the variables.
double gradient_error(const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected,
                      const Eigen::VectorXd& x) {
  const Eigen::MatrixXd difference = (found - expected) * x.asDiagonal();
  const Eigen::MatrixXd size = expected * x.asDiagonal();
  double worst = 0.0;
  for (Eigen::Index i = 0; i < size.rows(); ++i) {
    worst = std::max(
        worst, difference.row(i).lpNorm<Eigen::Infinity>() / size.row(i).lpNorm<Eigen::Infinity>());
  }
  return worst;
}

/// However the derivatives of the invariants come about, the gradients are as good as they are; the
/// motion is the same.
TEST(GradientsOfTheSliderCrank, AreAsGoodAsTheDerivativesOfTheInvariants) {
  const std::vector<std::string> quick = {"/simulation/end_time=20 ms", "/simulation/step=0.1 ms",
                                          "/scene/joints/bearing/drive/ramp=20 ms"};
  const auto run = [&](const std::string& choice, ExactMethod method) {
    std::vector<std::string> overrides = quick;
    overrides.push_back(R"(/sensitivity={"invariant_derivatives": ")" + choice + "\"}");
    const ProblemFile problem = sample_problem("slider_crank", overrides);
    const auto analysis = analyze(problem, start_design(problem));
    return sampled_gradients(*analysis, response_values(*analysis), method);
  };
  const Eigen::VectorXd x = start_design(sample_problem("slider_crank", quick));
  for (auto method : {ExactMethod::direct, ExactMethod::adjoint}) {
    const Eigen::MatrixXd exact = run("exact", method);
    // The same arithmetic; and ten times what was measured: 1e-9 and 1e-6.
    EXPECT_EQ(gradient_error(run("complex-step", method), exact, x), 0.0);
    EXPECT_LE(gradient_error(run("central", method), exact, x), 1e-8);
    const double forward = gradient_error(run("forward", method), exact, x);
    EXPECT_LE(forward, 1e-5);
    EXPECT_GT(forward, 1e-10) << "these were differences";
  }
}

}  // namespace
}  // namespace pleuel::test::invariant_choice_test
