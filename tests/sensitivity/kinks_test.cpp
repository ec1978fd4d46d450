#include "sensitivity/kinks.hpp"

#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"

namespace pleuel::test::kinks_test {
namespace {

/// A block that swings by A about factor · b, at A = 100 mm and b = 0: its greatest distance is
/// A + factor · b on one side and A − factor · b on the other. Relative to the scales of both, which
/// are 0.1 m, the gradients (1, ± factor) differ by 2 factor/√(1 + factor²).
ProblemFile block_with(double factor) {
  return read_problem_text(fmt::format(R"({{"scene": {{
          "bodies": {{"block": {{"type": "rigid", "at": [0, 0, 0], "mass": 1,
                                "inertia": [1, 1, 1, 0, 0, 0]}}}},
          "joints": {{"guide": {{"type": "prismatic", "bodies": ["ground", "block"],
            "at": [0, 0, 0], "axis": [1, 0, 0],
            "drive": {{"type": "harmonic", "amplitude": {{"variable": "A"}},
                       "frequency": "628.3185307179586 rad/s",
                       "offset": {{"variable": "b", "factor": {}}}}}}}}}}},
        "simulation": {{"end_time": "10 ms", "step": "0.05 ms"}},
        "variables": {{"A": {{"start": "100 mm", "lower": 0, "upper": 1}},
                       "b": {{"start": 0, "lower": -5, "upper": 5}}}},
        "responses": {{"reach": {{"type": "position", "body": "block", "direction": "x",
                                  "over_time": "max-abs"}}}}}})",
                                       factor),
                           "block.json")
      .complete();
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
    const ProblemFile problem = block_with(0.2);
    const auto analysis = analyze(problem, start_design(problem));
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

}  // namespace
}  // namespace pleuel::test::kinks_test
