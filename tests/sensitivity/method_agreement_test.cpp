#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "sensitivity/gradients.hpp"
#include "sensitivity/method_choice.hpp"
#include "tests/support/problem_runs.hpp"

namespace pleuel::test::method_agreement_test {
namespace {

class MethodsOfAProblem : public testing::TestWithParam<const char*> {};

/// Every response of every problem file, as the file stands: the two methods share the step's
/// tangents and nothing else.
TEST_P(MethodsOfAProblem, AgreeToRoundOff) {
  const ProblemFile problem = sample_problem(GetParam());
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const auto values = response_values(*analysis);
  const Eigen::MatrixXd direct =
      sampled_gradients(*analysis, values, ExactMethod::direct) * x.asDiagonal();
  const Eigen::MatrixXd adjoint =
      sampled_gradients(*analysis, values, ExactMethod::adjoint) * x.asDiagonal();
  for (Eigen::Index i = 0; i < direct.rows(); ++i) {
    EXPECT_LE((adjoint - direct).row(i).lpNorm<Eigen::Infinity>(),
              1e-10 * direct.row(i).lpNorm<Eigen::Infinity>())
        << problem.responses[i].name;
  }
}

INSTANTIATE_TEST_SUITE_P(Problems, MethodsOfAProblem,
                         testing::Values("slider_crank", "slider_crank_round",
                                         "slider_crank_tapered", "four_bar", "spatial_slider_crank",
                                         "robot_arm"),
                         [](const auto& test) { return std::string(test.param); });

/// Nothing is measured where the numbers settle it.
TEST(ChoiceOfAMethod, IsDirectForFewVariablesAndManyValues) {
  const ProblemFile problem = sample_problem("slider_crank_round");
  const auto analysis = analyze(problem, start_design(problem));
  const auto values = response_values(*analysis);
  ASSERT_GT(values.size(), problem.variables.size());
  const MethodChoice choice = choose_method(*analysis, values);
  EXPECT_EQ(choice.method, ExactMethod::direct);
  EXPECT_EQ(choice.reason.find("times"), std::string::npos) << choice.reason;
}

/// Measured times scatter by tens of percent.
TEST(ChoiceOfAMethod, IsTheAdjointIfThatIsClearlyFaster) {
  EXPECT_EQ(cheaper_method(2.0, 1.0), ExactMethod::adjoint);
  EXPECT_EQ(cheaper_method(1.1, 1.0), ExactMethod::direct);
  EXPECT_EQ(cheaper_method(1.0, 2.0), ExactMethod::direct);
}

/// One value of the motion, eight variables: both are measured. The gradient does not depend on
/// the choice.
TEST(ChoiceOfAMethod, LeavesTheGradientAsItIs) {
  ProblemFile problem = sample_problem("slider_crank_tapered");
  problem.responses.resize(2);  // the mass, and a stress
  problem.constraints.clear();
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const Eigen::MatrixXd automatic = gradients(problem, x, *analysis, GradientMethod::automatic);
  EXPECT_NE(choose_method(*analysis, response_values(*analysis)).reason.find("times"),
            std::string::npos);
  for (auto method : {GradientMethod::direct, GradientMethod::adjoint}) {
    const Eigen::MatrixXd other = gradients(problem, x, *analysis, method);
    EXPECT_LE((automatic - other).norm(), 1e-10 * other.norm()) << to_string(method);
  }
}

}  // namespace
}  // namespace pleuel::test::method_agreement_test
