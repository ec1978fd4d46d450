#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"

/// Loads a little beside nodes of the mesh, as written coordinates are rounded.
namespace pleuel::test::rounded_place_test {
namespace {

/// A clamped bar of 1 m, 40 mm in diameter, at rest.
Eigen::VectorXd values(const std::string& loads, const std::string& responses) {
  const ProblemFile problem = read_problem_text(fmt::format(R"j({{"scene": {{
    "bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel", "elements": 4,
      "section": {{"type": "circle", "diameter": "40 mm"}}}}}},
    "joints": {{"clamp": {{"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}}}},
    "loads": {{{}}}}},
  "effects": {{"geometric_stiffening": "off"}},
  "simulation": {{"end_time": "2 ms", "step": "1 ms", "initial_state": "quasi-static"}},
  "responses": {{{}}}}})j",
                                                            loads, responses),
                                                "bar.json")
                                  .complete();
  return values_of(*analyze(problem, start_design(problem)));
}

class Offsets : public testing::TestWithParam<double> {};

/// A couple of 50 N m bends all before it, M/W with W = π d³/32, and nothing behind it.
TEST_P(Offsets, LeaveTheJumpOfTheMomentWhereItIs) {
  const Eigen::VectorXd found = values(
      fmt::format(
          R"("turn": {{"type": "torque", "body": "bar", "at": [{:.17g}, 0, 0], "direction": [0, 0, 1],
                     "value": "50 N m"}})",
          0.5 + GetParam()),
      R"("stress": {"type": "stress", "body": "bar", "at": 0.5, "over_time": "final"},
         "before": {"type": "section-force", "body": "bar", "at": 0.5, "part": "moment-z", "side": "before",
                    "over_time": "final"},
         "behind": {"type": "section-force", "body": "bar", "at": 0.5, "part": "moment-z", "side": "behind",
                    "over_time": "final"})");
  const double stress = 50.0 * 32.0 / (M_PI * std::pow(0.04, 3));
  EXPECT_NEAR(found(0), stress, 1e-6 * stress);
  EXPECT_NEAR(std::abs(found(1)), 50.0, 1e-5);
  EXPECT_NEAR(found(2), 0.0, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(OfALoad, Offsets, testing::Values(0.0, 1e-8, 5e-7, -5e-7, 5e-6),
                         [](const auto& test) { return fmt::format("Number{}", test.index); });

/// 50 kN at 2.4 mm from the clamp, a hundredth of the element, and 500 N at the tip.
TEST(AForceBesideAClamp, IsThereInSectionForces) {
  const Eigen::VectorXd found = values(
      R"("near": {"type": "force", "body": "bar", "at": ["2.4 mm", 0, 0], "direction": [0, -1, 0], "value": "50 kN"},
         "tip": {"type": "force", "body": "bar", "at": [1, 0, 0], "direction": [0, -1, 0], "value": "500 N"})",
      R"("shear": {"type": "section-force", "body": "bar", "at": 0, "part": "shear-y", "over_time": "final"},
         "moment": {"type": "section-force", "body": "bar", "at": 0, "part": "moment-z", "over_time": "final"})");
  EXPECT_NEAR(std::abs(found(0)), 50500.0, 0.5);
  EXPECT_NEAR(std::abs(found(1)), 50e3 * 2.4e-3 + 500.0, 1e-2);
}

}  // namespace
}  // namespace pleuel::test::rounded_place_test
