#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/scene/problem_reader.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/support/problem_runs.hpp"

namespace pleuel::test::gradient_test {
namespace {

struct Case {
  std::string problem;
  std::vector<std::string> overrides;
};

class GradientsOfAProblem : public testing::TestWithParam<Case> {
 protected:
  GradientsOfAProblem() {
    std::vector<std::string> overrides = {"/simulation/end_time=0.072 s",
                                          "/simulation/step=1e-4 s"};
    overrides.insert(overrides.end(), GetParam().overrides.begin(), GetParam().overrides.end());
    problem_ = sample_problem(GetParam().problem, overrides);
    problem_.simulation.newton_tolerance = 1e-12;
    x_ = start_design(problem_);
    // Away from the start, where the peaks of the rod's bow nearly tie.
    for (Eigen::Index i = 0; i < x_.size(); ++i) x_(i) *= 0.75 - 0.03 * double(i % 3);
  }
  ProblemFile problem_;
  Eigen::VectorXd x_;
};

/// V-curve of central differences and of their extrapolation: at the best step, or the first that is
/// good enough, the error is ≤ 1e-7 of the largest entry (per relative change of a variable) for
/// peaks and ends, ≤ 1e-9 for mass and rms.
TEST_P(GradientsOfAProblem, AreThoseOfCentralDifferencesAtTheBestStep) {
  const auto analysis = analyze(problem_, x_);
  const Eigen::MatrixXd direct = direct_gradients(*analysis) * x_.asDiagonal();
  Eigen::VectorXd best = Eigen::VectorXd::Ones(direct.rows());
  // Positions hardly depend on the sections: what counts there is the round-off of the mechanism's
  // size (0.3 m) over the narrowest step.
  const double round_off = 1e-16 * 0.3 / 2.5e-5;
  Eigen::VectorXd allowed(direct.rows());
  for (Eigen::Index i = 0; i < direct.rows(); ++i) {
    const auto& response = problem_.responses[i];
    const bool is_smooth =
        response.type == ResponseType::mass || response.over_time == OverTime::rms;
    allowed(i) = is_smooth ? 1e-9 : 1e-7;
  }
  const auto compare = [&](const Eigen::MatrixXd& differences) {
    for (Eigen::Index i = 0; i < direct.rows(); ++i) {
      const bool is_position = problem_.responses[i].type == ResponseType::position;
      const double error = (differences.row(i) - direct.row(i)).lpNorm<Eigen::Infinity>() -
                           (is_position ? round_off : 0.0);
      best(i) = std::min(best(i), std::max(error, 0.0) / direct.row(i).lpNorm<Eigen::Infinity>());
    }
  };
  for (double step : {1e-3, 5e-4, 5e-5}) {
    const Eigen::MatrixXd wide = central_differences(problem_, x_, step) * x_.asDiagonal();
    const Eigen::MatrixXd narrow = central_differences(problem_, x_, step / 2) * x_.asDiagonal();
    compare(wide);
    compare(narrow);
    compare((4 * narrow - wide) / 3);
    if ((best.array() <= allowed.array()).all()) break;
  }
  for (Eigen::Index i = 0; i < direct.rows(); ++i) {
    const auto& response = problem_.responses[i];
    const auto& ties = analysis->reductions[i].ties;
    EXPECT_TRUE(ties.empty()) << response.name << ": no kink may be here";
    EXPECT_LE(best(i), allowed(i)) << response.name;
  }
}

std::string case_name(const testing::TestParamInfo<Case>& info) {
  return info.param.problem;
}

INSTANTIATE_TEST_SUITE_P(
    Problems, GradientsOfAProblem,
    testing::Values(Case{"slider_crank",
                         {"/scene/bodies/crank/elements=3", "/scene/bodies/rod/elements=4"}},
                    Case{"slider_crank_round",
                         {"/scene/bodies/crank/elements=3", "/scene/bodies/rod/elements=4"}},
                    Case{"slider_crank_tapered", {"/simulation/end_time=0.06 s"}}),
    case_name);

/// A variable at 0 with a range of 2 mrad: y = 100 mm · sin(1000 p). A step of 1e-5 without regard
/// of the range would turn the arm by 0.01 rad and err by 0.01² / 6.
TEST(Differences, OfAVariableAtZeroTakeTheirStepFromItsRange) {
  const ProblemFile problem = read_problem_text(R"({
    "scene": {
      "bodies": {"arm": {"type": "beam", "from": [0, 0, 0], "to": ["100 mm", 0, 0], "rigid": true,
        "material": "steel", "elements": 2, "section": {"type": "circle", "diameter": "10 mm"}}},
      "joints": {"bearing": {"type": "revolute", "bodies": ["ground", "arm"], "at": [0, 0, 0],
        "drive": {"type": "constant", "value": {"variable": "p", "factor": 1000}}}}},
    "simulation": {"end_time": "2 ms", "step": "1 ms"},
    "variables": {"p": {"start": 0, "lower": -0.001, "upper": 0.001}},
    "responses": {"y": {"type": "position", "body": "arm", "at": 1, "direction": "y",
      "over_time": "final"}}})",
                                                "arm.json")
                                  .complete();
  const Eigen::VectorXd x = start_design(problem);
  EXPECT_NEAR(central_differences(problem, x, 1e-5)(0, 0), 100.0, 1e-5);
  EXPECT_NEAR(forward_differences(problem, x, *analyze(problem, x), 1e-5)(0, 0), 100.0, 1e-5);
}

/// Beyond a hundredth of the range the value counts.
TEST(Differences, TakeTheirStepFromTheValueElsewhere) {
  const DesignVariable variable{"x", 1.0, -2.0, 8.0, ""};
  EXPECT_EQ(step_scale(variable, -1.5), 1.5);
  EXPECT_DOUBLE_EQ(step_scale(variable, 0.01), 0.1);
  EXPECT_EQ(step_scale({"x", 0.0, 0.0, 0.0, ""}, 0.0), 1.0);
}

}  // namespace
}  // namespace pleuel::test::gradient_test
