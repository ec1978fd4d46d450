#include "core/base/eager_matrices.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/hard/hard_problems.hpp"

namespace pleuel::test::gradient_test {
namespace {

struct GradientCase {
  std::string name, problem;
  std::vector<std::string> overrides;  ///< short runs: differences of long ones are round-off
  double tolerance;                    ///< relative to the largest entry of a response
};

class HardGradient : public testing::TestWithParam<std::tuple<std::string, GradientCase>> {};

/// The problem of a case; its Newton iterations end at round-off.
ProblemFile problem_of(const GradientCase& hard, const std::string& formulation) {
  std::vector<std::string> overrides = hard.overrides;
  overrides.push_back("/simulation/formulation=" + formulation);
  ProblemFile problem = sample_problem("hard/" + hard.problem, overrides);
  problem.simulation.newton_tolerance = 1e-13;
  return problem;
}

/// Central differences of several steps and Richardson's extrapolation of two: the best of them is
/// as good as the round-off and the truncation of differences allow. Those
/// that are left when it is good enough are not taken.
TEST_P(HardGradient, IsThatOfCentralDifferencesAtTheBestStep) {
  const auto& [formulation, hard] = GetParam();
  const ProblemFile problem = problem_of(hard, formulation);
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const Eigen::VectorXd direct = direct_gradients(*analysis) * x;
  // Against a thousandth of the value where it hardly depends on the design.
  Eigen::VectorXd best = Eigen::VectorXd::Ones(direct.size());
  const auto compare = [&](const Eigen::VectorXd& differences) {
    for (Eigen::Index i = 0; i < direct.size(); ++i) {
      const double value = std::abs(analysis->reductions[i].value);
      const double size = std::max(std::abs(direct(i)), 1e-3 * value);
      best(i) = std::min(best(i), std::abs(differences(i) - direct(i)) / size);
    }
  };
  for (const double step : {1e-3, 1e-2, 1e-4}) {
    const Eigen::VectorXd wide = central_differences(problem, x, step) * x;
    const Eigen::VectorXd narrow = central_differences(problem, x, step / 2) * x;
    compare(narrow);
    compare((4 * narrow - wide) / 3);
    if (best.maxCoeff() <= hard.tolerance) break;
  }
  for (Eigen::Index i = 0; i < direct.size(); ++i) {
    const std::string& name = problem.responses[i].name;
    EXPECT_LE(best(i), hard.tolerance) << name;
  }
}

/// The transposed map, backwards: no differences, no truncation, only round-off. Against a
/// thousandth of the value where it hardly depends on the design.
TEST_P(HardGradient, IsThatOfTheAdjoint) {
  const auto& [formulation, hard] = GetParam();
  const ProblemFile problem = problem_of(hard, formulation);
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const auto values = response_values(*analysis);
  const Eigen::VectorXd direct = sampled_gradients(*analysis, values, ExactMethod::direct) * x;
  const Eigen::VectorXd adjoint = sampled_gradients(*analysis, values, ExactMethod::adjoint) * x;
  for (Eigen::Index i = 0; i < direct.size(); ++i) {
    const double value = std::abs(analysis->reductions[i].value);
    EXPECT_LE(std::abs(adjoint(i) - direct(i)), 1e-8 * std::max(std::abs(direct(i)), 1e-3 * value))
        << problem.responses[i].name;
  }
}

std::string case_name(const testing::TestParamInfo<HardGradient::ParamType>& info) {
  std::string name = std::get<0>(info.param) + std::get<1>(info.param).name;
  std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
  return name;
}

/// Limits: measured times ten. Where they are above 1e-8, round-off of the differences is
/// amplified: by the many steps of a coasting mechanism, by stiffness, by vibrations that nothing
/// damps, by the torque of a jump, hundreds of times its mean.
INSTANTIATE_TEST_SUITE_P(
    Problems, HardGradient,
    testing::Combine(
        testing::ValuesIn(formulations()),
        testing::Values(
            GradientCase{"dead_centres", "dead_centres", {"/simulation/end_time=0.4"}, 3e-7},
            GradientCase{"change_point", "change_point", {}, 1e-9},
            GradientCase{"heavy_slider", "heavy_slider", {}, 2e-9},
            GradientCase{"light_slider", "light_slider", {}, 1e-8},
            GradientCase{"stiff_rod", "stiff_rod", {}, 1e-6},
            GradientCase{"soft_rod", "soft_rod", {}, 2e-8},
            GradientCase{"fast_crank", "fast_crank", {"/simulation/end_time=0.01"}, 2e-6},
            GradientCase{
                "inconsistent_start", "inconsistent_start", {"/simulation/end_time=0.1"}, 4e-6},
            GradientCase{"sudden_load", "sudden_load", {"/simulation/end_time=0.05"}, 5e-9},
            GradientCase{"squeezer", "squeezer", {}, 2e-7},
            GradientCase{"free_vibration",
                         "free_vibration",
                         {"/simulation/end_time=20", "/responses/last_peak/from=18"},
                         4e-8},
            GradientCase{"flyball_governor", "flyball_governor", {"/simulation/end_time=1"}, 1e-8},
            GradientCase{"velocity_jump", "velocity_jump", {}, 1.2e-5},
            // Loads out of the plane, which redundant joints share.
            GradientCase{
                "redundant",
                "redundant_slider_crank",
                {"/simulation/end_time=0.2", "/scene/gravity=[0, -9.81, 20]",
                 R"(/responses/pin_force={"type": "reaction-force", "joint": "slider_pin", "direction": "z", "over_time": "rms"})",
                 R"(/responses/pin_moment={"type": "reaction-moment", "joint": "crank_pin", "direction": "magnitude", "over_time": "rms"})"},
                1e-7},
            GradientCase{"thinnest", "light_slider", {"/variables/rod_height/start=4 mm"}, 2e-7},
            GradientCase{"thickest", "light_slider", {"/variables/rod_height/start=40 mm"}, 2e-8},
            GradientCase{"softest", "soft_rod", {"/variables/rod_diameter/start=4 mm"}, 1e-8},
            GradientCase{"heaviest",
                         "fast_crank",
                         {"/variables/slider_mass/start=1 kg", "/simulation/end_time=0.01"},
                         5e-8})),
    case_name);

}  // namespace
}  // namespace pleuel::test::gradient_test
