#include "sensitivity/kinks.hpp"

#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"

namespace pleuel::test::kinks_test {
namespace {

/// A block that swings by A about factor · b, at A = 100 mm and b = 0: its greatest distance is
/// A + factor · b on one side and A − factor · b on the other, and the gradients (1, ± factor)
/// differ by 2 factor/√(1 + factor²).
std::unique_ptr<Analysis> block_with(double factor) {
  const ProblemFile problem = read_problem_text(fmt::format(R"({{"scene": {{
          "bodies": {{"block": {{"type": "rigid", "at": [0, 0, 0], "mass": 1,
                                "inertia": [1, 1, 1, 0, 0, 0]}}}},
          "joints": {{"guide": {{"type": "prismatic", "bodies": ["ground", "block"],
            "at": [0, 0, 0], "axis": [1, 0, 0],
            "drive": {{"type": "harmonic", "amplitude": {{"variable": "A"}},
                       "frequency": "628.3185307179586 rad/s",
                       "offset": {{"variable": "b", "factor": {}}}}}}}}}}},
        "simulation": {{"end_time": "10 ms", "step": "0.05 ms"}},
        "variables": {{"A": {{"start": "100 mm", "lower": 0, "upper": 1}},
                       "b": {{"start": 0, "lower": -1, "upper": 1}}}},
        "responses": {{"reach": {{"type": "position", "body": "block", "direction": "x",
                                  "over_time": "max-abs"}}}}}})",
                                                            factor),
                                                "block.json")
                                  .complete();
  return analyze(problem, start_design(problem));
}

std::vector<Kink> kinks_with(double factor) {
  return find_kinks(*block_with(factor));
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

TEST(Kinks, AreTheSameByTheWayOfGradients) {
  for (const ExactMethod method : {ExactMethod::direct, ExactMethod::adjoint}) {
    const auto analysis = block_with(0.2);
    const GradientsAndKinks both = gradients_and_kinks(*analysis, method);
    const Eigen::MatrixXd gradients =
        sampled_gradients(*analysis, response_values(*analysis), method);
    EXPECT_LE((both.gradients - gradients).lpNorm<Eigen::Infinity>(), 1e-14);
    const std::vector<Kink> alone = find_kinks(*analysis);
    ASSERT_EQ(both.kinks.size(), alone.size());
    ASSERT_EQ(alone.size(), 1u);
    EXPECT_EQ(both.kinks[0].response, alone[0].response);
    EXPECT_NEAR(both.kinks[0].difference, alone[0].difference, 1e-12);
  }
}

}  // namespace
}  // namespace pleuel::test::kinks_test
