#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/response/analysis.hpp"
#include "tests/support/problem_runs.hpp"

namespace pleuel::test::mesh_test {
namespace {

Eigen::VectorXd values_with(const std::string& elements) {
  const ProblemFile problem =
      sample_problem("slider_crank", {"/simulation/end_time=0.07 s", "/simulation/step=5e-5 s",
                                      "/scene/bodies/crank/elements=" + elements,
                                      "/scene/bodies/rod/elements=" + elements});
  const Eigen::VectorXd x = 0.75 * start_design(problem);
  return values_of(*analyze(problem, x));
}

/// Six elements are enough for the peaks: fixed-end terms leave no error of wℓ²/12 at the nodes.
TEST(Mesh, OfSixElementsHasThePeaksOfTwentyFour) {
  const Eigen::VectorXd coarse = values_with("6"), fine = values_with("24");
  const ProblemFile problem = sample_problem("slider_crank");
  for (Eigen::Index i = 0; i < coarse.size(); ++i) {
    EXPECT_NEAR(coarse(i) / fine(i), 1.0, 0.01) << problem.responses[i].name;
  }
}

}  // namespace
}  // namespace pleuel::test::mesh_test
