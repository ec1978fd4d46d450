#include "sensitivity/kinks.hpp"

#include <memory>

#include "core/base/eager_matrices.hpp"
#include "core/response/analysis.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::kinks_test {
namespace {

/// A block that swings by A about factor · b, at A = 100 mm and b = 0: its greatest distance is
/// A + factor · b on one side and A − factor · b on the other. Relative to the scales of both, which
/// are 0.1 m, the gradients (1, ± factor) differ by 2 factor/√(1 + factor²).
ProblemFile block_with(double factor) {
  return problem_from(fmt::format(R"({{"scene": {{
          "bodies": {{"block": {{"type": "rigid", "at": [0, 0, 0], "mass": 1, "inertia": [1, 1, 1, 0, 0, 0]}}}},
          "joints": {{"guide": {{"type": "prismatic", "bodies": ["ground", "block"],
            "at": [0, 0, 0], "axis": [1, 0, 0],
            "drive": {{"type": "harmonic", "amplitude": {{"variable": "A"}}, "frequency": "628.3185307179586 rad/s",
                       "offset": {{"variable": "b", "factor": {}}}}}}}}}}},
        "simulation": {{"end_time": "10 ms", "step": "0.05 ms"}},
        "variables": {{"A": {{"start": "100 mm", "lower": 0, "upper": 1}},
                       "b": {{"start": 0, "lower": -5, "upper": 5}}}},
        "responses": {{"reach": {{"type": "position", "body": "block", "direction": "x",
                                  "over_time": "max-abs"}}}}}})",
                                  factor));
}

std::vector<Kink> kinks_with(double factor) {
  const ProblemFile problem = block_with(factor);
  return find_kinks(*analyze(problem, start_design(problem)), problem.variables);
}

/// Peaks that tie are a kink where their gradients differ by more than a hundredth.
TEST(Kinks, AreTiesWhoseGradientsDifferByMoreThanAHundredth) {
  for (const double factor : {0.006, 0.02, 0.1, 0.2, 1.0}) {
    const std::vector<Kink> kinks = kinks_with(factor);
    ASSERT_EQ(kinks.size(), 1u) << factor;
    EXPECT_EQ(kinks[0].response, 0u);
    const double expected = 2.0 * factor / std::sqrt(1.0 + factor * factor);
    EXPECT_NEAR(kinks[0].difference, expected, 1e-3 * expected) << factor;
  }
  EXPECT_TRUE(kinks_with(0.004).empty());
}

/// The unit of a variable says nothing: per metre the second change is a millionth of the first.
TEST(GradientDifference, IsOneOfChangesOfTheDesign) {
  const Eigen::RowVector2d g(3e6, 4.0), h(3e6, -4.0);
  EXPECT_NEAR(gradient_difference(g, h, Eigen::Vector2d(1e-6, 1.0)), 8.0 / 5.0, 1e-15);
}

TEST(GradientDifference, IsWholeWhereOneOfThemVanishes) {
  const Eigen::RowVector2d g(1.0, 2.0), none(0.0, 0.0);
  const Eigen::Vector2d scales(1.0, 1.0);
  EXPECT_EQ(gradient_difference(none, g, scales), 1.0);
  EXPECT_EQ(gradient_difference(g, none, scales), 1.0);
  EXPECT_EQ(gradient_difference(none, none, scales), 0.0);
}

TEST(Kinks, AreTheSameByTheWayOfGradients) {
  for (const ExactMethod method : {ExactMethod::direct, ExactMethod::adjoint}) {
    const auto [problem, x, analysis] = AtStart(block_with(0.2));
    const GradientsAndKinks both = gradients_and_kinks(*analysis, problem.variables, method);
    const Eigen::MatrixXd gradients =
        sampled_gradients(*analysis, response_values(*analysis), method);
    EXPECT_LE((both.gradients - gradients).lpNorm<Eigen::Infinity>(), 1e-14);
    const std::vector<Kink> alone = find_kinks(*analysis, problem.variables);
    ASSERT_EQ(both.kinks.size(), alone.size());
    ASSERT_EQ(alone.size(), 1u);
    EXPECT_EQ(both.kinks[0].response, alone[0].response);
    EXPECT_NEAR(both.kinks[0].difference, alone[0].difference, 1e-12);
  }
}

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

/// What a designer asks of beams with modes: where places are, how far they bend. No response
/// depends on the choice of a basis within its span.
ProblemFile problem_of(const SampleScene& sample) {
  ProblemFile problem;
  problem.scene = sample.scene;
  problem.effects = sample.effects;
  problem.simulation.end_time = 0.02;
  problem.simulation.step = 1e-3;
  problem.simulation.newton_tolerance = 1e-12;
  for (std::size_t i = 0; i < sample.design.size(); ++i) {
    DesignVariable variable;
    variable.name = sample.variables[i];
    variable.start = sample.design[i];
    problem.variables.push_back(variable);
  }
  problem.responses = {{"tip of crank", PointMotionResponse{{"crank", 1.0}}, OverTime::final},
                       {"bow of crank", DeflectionResponse{{"crank", 0.5}}, OverTime::final},
                       {"place on rod", PointMotionResponse{{"rod", 0.35}}, OverTime::final},
                       {"bow of rod", DeflectionResponse{{"rod", 0.6}}, OverTime::rms},
                       {"root of flag", DeflectionResponse{{"flag", 0.0}}, OverTime::rms},
                       {"tip of flag", PointMotionResponse{{"flag", 1.0}}, OverTime::final},
                       {"end of arm", PointMotionResponse{{"arm", 1.0}}, OverTime::final},
                       {"bow of arm", DeflectionResponse{{"arm", 1.0}}, OverTime::final}};
  return problem;
}

class ReducedBodies : public testing::TestWithParam<int> {};

/// Every neighbouring design is reduced anew. Central differences at the best step of a V-curve,
/// of what a relative change of a variable does, against the largest such effect: 1e-7 as for full
/// models. The round bars have pairs of equal frequencies in space.
TEST_P(ReducedBodies, HaveTheGradientsOfModelsThatAreReducedAnew) {
  const SampleScene sample = all_samples()[GetParam()];
  const auto [problem, x, analysis] = AtStart(problem_of(sample));
  const Eigen::MatrixXd direct = direct_gradients(*analysis) * x.asDiagonal();
  Eigen::MatrixXd best = Eigen::MatrixXd::Ones(direct.rows(), direct.cols());
  for (double step : {1e-3, 1e-4}) {
    const Eigen::MatrixXd wide = central_differences(problem, x, step) * x.asDiagonal();
    const Eigen::MatrixXd narrow = central_differences(problem, x, step / 2) * x.asDiagonal();
    best = best.cwiseMin(((4 * narrow - wide) / 3 - direct).cwiseAbs());
    best = best.cwiseMin((narrow - direct).cwiseAbs());
  }
  for (Eigen::Index i = 0; i < direct.rows(); ++i) {
    const double scale = direct.row(i).lpNorm<Eigen::Infinity>();
    for (Eigen::Index j = 0; j < direct.cols(); ++j) {
      EXPECT_LE(best(i, j), 1e-7 * scale)
          << problem.responses[i].name << ", " << sample.variables[j];
    }
    EXPECT_GT(scale, 0.0);
  }
}

/// The reduced samples.
INSTANTIATE_TEST_SUITE_P(Samples, ReducedBodies, testing::Values(5, 6), sample_name);

}  // namespace
}  // namespace pleuel::test::kinks_test
