#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/response/analysis.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/core/trust/findings_of.hpp"
#include "tests/support/problem_runs.hpp"

/// Frequencies of mechanisms whose motion begins with undeformed members under loads: those about
/// the equilibrium.
namespace pleuel::test::vibration_state_test {
namespace {

constexpr double young = 2.1e11, length = 1.0, height = 0.01, width = 0.04;

/// A column on two pins that its ends leave free to turn, pressed by P.
ProblemFile column(double P) {
  return read_scene(fmt::format(R"j({{
    "scene": {{
      "materials": {{"m": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
      "bodies": {{"b": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "m",
        "section": {{"type": "rectangle", "width": 0.04, "height": 0.01}}, "elements": 8,
        "frame": "chord"}}}},
      "joints": {{
        "a": {{"type": "revolute", "bodies": ["ground", "b"], "at": [0, 0, 0]}},
        "c": {{"type": "point-on-line", "bodies": ["ground", "b"], "at": [1, 0, 0], "axis": [1, 0, 0]}}}},
      "loads": {{"P": {{"type": "force", "body": "b", "at": [1, 0, 0], "direction": [-1, 0, 0],
                        "value": {{"variable": "P"}}}}}}}},
    "simulation": {{"end_time": 1e-4, "step": 1e-4}},
    "variables": {{"P": {{"start": {}, "lower": 0, "upper": 1e5}}}},
    "responses": {{"f": {{"type": "frequency"}}}}}})j",
                                P));
}

/// ω = ω₀ √(1 − P/P_E) with Euler's load, beyond it −γ = −ω₀ √(P/P_E − 1); its slope −ω₀²/(2 ω P_E).
TEST(FrequencyUnderALoad, IsThatOfThePressedColumnThoughItStartsUndeformed) {
  const double bending = young * width * std::pow(height, 3) / 12;
  const double euler = bending * std::pow(std::numbers::pi / length, 2);
  const double free =
      std::pow(std::numbers::pi / length, 2) * std::sqrt(bending / (7850 * width * height));
  for (const double share : {0.5, 0.95, 1.5}) {
    const ProblemFile problem = column(share * euler);
    const auto analysis = analyze(problem, start_design(problem));
    const double expected = std::copysign(std::sqrt(std::abs(1 - share)), 1 - share) * free;
    EXPECT_NEAR(values_of(*analysis)(0), expected, 2e-3 * std::abs(expected)) << share;
    const double slope = -free * free / (2 * std::abs(expected) * euler);
    EXPECT_NEAR(direct_gradients(*analysis)(0, 0), slope, 4e-3 * std::abs(slope)) << share;
  }
}

/// A lever that a motor turns against a stop, with an arm welded to it.
ProblemFile lever(int elements, double torque) {
  return read_scene(fmt::format(R"j({{
    "scene": {{
      "bodies": {{
        "arm": {{"type": "beam", "from": [0, 0, 0], "to": [0.5, 0, 0], "material": "steel", "elements": {0},
          "section": {{"type": "rectangle", "width": 0.03, "height": 0.015}}}},
        "lever": {{"type": "beam", "from": [0, 0, 0], "to": [0, 0.075, 0], "material": "steel", "elements": {0},
          "section": {{"type": "rectangle", "width": 0.02, "height": 0.008}}}},
        "blade": {{"type": "point-mass", "at": [0.5, 0, 0], "mass": 0.3}}}},
      "joints": {{
        "pivot": {{"type": "revolute", "bodies": ["ground", "lever"], "at": [0, 0, 0]}},
        "weld": {{"type": "fixed", "bodies": ["lever", "arm"], "at": [0, 0, 0]}},
        "tip": {{"type": "spherical", "bodies": ["arm", "blade"], "at": [0.5, 0, 0]}},
        "stop": {{"type": "point-on-line", "bodies": ["ground", "lever"], "at": [0, 0.075, 0],
                  "axis": [0, 1, 0]}}}},
      "loads": {{"T": {{"type": "joint", "joint": "pivot", "motor": {1}}}}}}},
    "simulation": {{"end_time": 1e-4, "step": 1e-4}},
    "responses": {{"f": {{"type": "frequency", "direction": "y"}}}}}})j",
                                elements, torque));
}

/// Accelerations of members that are let go under a load grow with the mesh; they are none of a
/// vibration. Without the motor they vanish.
TEST(FrequencyUnderALoad, DoesNotDependOnTheMesh) {
  const auto frequency = [](int elements, double torque) {
    const ProblemFile problem = lever(elements, torque);
    return values_of(*analyze(problem, start_design(problem)))(0);
  };
  const double expected = frequency(4, 0.0);
  for (const int elements : {2, 8, 24}) {
    EXPECT_NEAR(frequency(elements, 5.0), expected, 1e-3 * expected) << elements;
  }
}

TEST(FrequencyUnderALoad, IsDoubtedWhereThereIsNoEquilibrium) {
  const auto pushed = [](double force) {
    return read_scene(fmt::format(R"j({{
      "scene": {{
        "bodies": {{"b": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
          "section": {{"type": "rectangle", "width": 0.01, "height": 0.01}}, "elements": 4}}}},
        "joints": {{"wall": {{"type": "fixed", "bodies": ["ground", "b"], "at": [0, 0, 0]}}}},
        "loads": {{"P": {{"type": "force", "body": "b", "at": [1, 0, 0], "direction": [0, 1, 0],
                          "value": {}}}}}}},
      "simulation": {{"end_time": 1e-5, "step": 1e-5}},
      "responses": {{"f": {{"type": "frequency"}}}}}})j",
                                  force));
  };
  const auto findings = [](const ProblemFile& problem) {
    for (const Finding& finding : findings_of(problem)) {
      const bool is_of_equilibrium = finding.text.find("undeformed members") != std::string::npos;
      if (is_of_equilibrium) return finding.is_serious;
    }
    return false;
  };
  EXPECT_FALSE(findings(pushed(10)));
  EXPECT_TRUE(findings(pushed(1e7)));
}

}  // namespace
}  // namespace pleuel::test::vibration_state_test
