#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/scene/problem_reader.hpp"
#include "sensitivity/gradients.hpp"

/// Elements much shorter than others have stiffnesses whose round-off drowns small differences.
namespace pleuel::test::short_elements_test {
namespace {

/// The first frequency of a bar on two supports, with the inertia of its turning sections
///     f ∝ h/√(1 + π² h²/(12 L²))
/// has nothing to do with where two loads bend it a little; the element between them is a
/// three-hundredth, or a thousandth, of the bar.
TEST(FrequencyBesideShortElements, HasTheDerivativesOfABar) {
  for (const double gap : {3.0, 1.0}) {
    const ProblemFile problem = read_problem_text(fmt::format(R"j({{"scene": {{
          "bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
            "elements": 6, "section": {{"type": "rectangle", "width": "40 mm", "height": {{"variable": "h"}}}}}}}},
          "joints": {{
            "left": {{"type": "revolute", "bodies": ["ground", "bar"], "at": [0, 0, 0]}},
            "right": {{"type": "point-on-line", "bodies": ["ground", "bar"], "at": [1, 0, 0], "axis": [1, 0, 0]}}}},
          "loads": {{
            "P": {{"type": "force", "body": "bar", "at": [0.5, 0, 0], "direction": [0, -1, 0], "value": 10}},
            "Q": {{"type": "force", "body": "bar", "at": [{{"variable": "a"}}, 0, 0], "direction": [0, -1, 0],
                   "value": 10}}}}}},
        "simulation": {{"end_time": "2 ms", "step": "1 ms", "initial_state": "quasi-static"}},
        "variables": {{"h": {{"start": "20 mm", "lower": "5 mm", "upper": "90 mm"}},
                       "a": {{"start": "{} mm", "lower": "500.5 mm", "upper": "900 mm"}}}},
        "responses": {{"f": {{"type": "frequency"}}}}}})j",
                                                              500.0 + gap),
                                                  "bar.json")
                                    .complete();
    const auto analysis = analyze(problem, start_design(problem));
    const double f = values_of(*analysis)(0);
    const Eigen::MatrixXd slopes = direct_gradients(*analysis);
    const double turning = std::pow(std::numbers::pi * 0.02, 2) / 12;
    EXPECT_NEAR(slopes(0, 0) * 0.02, f / (1 + turning), 1e-5 * f) << gap;
    EXPECT_NEAR(slopes(0, 1), 0.0, 1e-3 * f) << gap;
  }
}

}  // namespace
}  // namespace pleuel::test::short_elements_test
