#include "core/trust/unstable_members.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/core/trust/doubts_of.hpp"

/// A square column of 1 m × 10 mm, pressed slowly: EI = 175 N m².
namespace pleuel::test {
namespace {

constexpr double stiffness = 2.1e11 * 1e-8 / 12;

std::vector<Doubt> doubts_of_column(const std::string& bodies, const std::string& joints,
                                    const std::string& loaded, double at, double force) {
  const std::string text = fmt::format(
      R"j({{"scene": {{
        "materials": {{"light": {{"young": 2.1e11, "poisson": 0.3, "density": 1}}}},
        "bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "elements": 6,
                            "material": "light", "damping": {{"stiffness": 1e-4}},
                            "section": {{"type": "rectangle", "width": 0.01, "height": 0.01}}}}{}}},
        "joints": {{{}}},
        "loads": {{"press": {{"type": "force", "body": "{}", "at": [{}, 0, 0],
                             "direction": [-1, 0, 0],
                             "value": {{"type": "ramp", "to": {}, "end": 0.05}}}}}}}},
      "effects": {{"spatial_motion": "on", "geometric_stiffening": "on"}},
      "simulation": {{"end_time": 0.05, "step": 0.0025}},
      "responses": {{"mass": {{"type": "mass"}}}}}})j",
      bodies, joints, loaded, at, force);
  return doubts_of(read_scene(text), doubt_unstable_members);
}

std::string rigid(const std::string& name, double at) {
  return fmt::format(R"(, "{}": {{"type": "rigid", "at": [{}, 0, 0], "mass": 1e-4,
                                 "inertia": [1e-8, 1e-8, 1e-8, 0, 0, 0]}})",
                     name, at);
}

/// Root of u tan u = right below π/2.
double root(double right) {
  double low = 0.0, high = std::numbers::pi / 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (middle * std::tan(middle) < right ? low : high) = middle;
  }
  return low;
}

/// One doubt, serious, at 1.02 of a critical load; none at 0.98 of it.
template <class DoubtsAt>
void expect_critical(double load, const DoubtsAt& doubts_at) {
  EXPECT_TRUE(doubts_at(0.98 * load).empty());
  const std::vector<Doubt> doubts = doubts_at(1.02 * load);
  ASSERT_EQ(doubts.size(), 1);
  EXPECT_TRUE(doubts[0].is_serious);
  EXPECT_NE(doubts[0].text.find("\"bar\" buckles"), std::string::npos) << doubts[0].text;
}

const std::string clamp =
    R"("wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]})";

TEST(UnstableMembers, AreToldFromTheEulerLoadOfACantileverOn) {
  const double euler = std::numbers::pi * std::numbers::pi * stiffness / 4;
  expect_critical(euler, [](double force) { return doubts_of_column("", clamp, "bar", 1, force); });
}

/// A rigid mast of d on the tip, pressed at its top: P = EI u²/L² with u tan u = L/d (the moment at the
/// tip is P times the way of the top).
TEST(UnstableMembers, IncludeTheWayOfALoadAboveTheTip) {
  for (const double height : {1.0, 10.0}) {
    const double u = root(1.0 / height);
    expect_critical(stiffness * u * u, [height](double force) {
      return doubts_of_column(rigid("mast", 1 + height),
                              clamp + R"(, "weld": {"type": "fixed", "bodies": ["bar", "mast"],
                                                "at": [1, 0, 0]})",
                              "mast", 1 + height, force);
    });
  }
}

/// Rigid eyes of d at both ends on pins: P = EI (2u/L)² with u tan u = L/(2d).
TEST(UnstableMembers, IncludeTheTurningOfEndFittings) {
  const double u = root(0.5 / 0.12);
  expect_critical(4 * stiffness * u * u, [](double force) {
    return doubts_of_column(rigid("left", -0.12) + rigid("right", 1.12),
                            R"("a": {"type": "fixed", "bodies": ["bar", "left"], "at": [0, 0, 0]},
           "b": {"type": "fixed", "bodies": ["bar", "right"], "at": [1, 0, 0]},
           "pin": {"type": "universal", "bodies": ["ground", "left"], "at": [-0.12, 0, 0],
                   "axis": [0, 1, 0], "second_axis": [0, 0, 1]},
           "line": {"type": "point-on-line", "bodies": ["ground", "right"], "at": [1.12, 0, 0],
                    "axis": [1, 0, 0]})",
                            "right", 1.12, force);
  });
}

}  // namespace
}  // namespace pleuel::test
