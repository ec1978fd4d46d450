#include "core/response/analysis.hpp"
#include "core/response/buckling_signal.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::sheared_forces_test {
namespace {

constexpr double young = 2.1e11, shear_modulus = young / 2.6, density = 7850;
constexpr double length = 0.5, area = 0.02, inertia = 7e-5, shear_area = 0.004;

/// A beam of 0.5 m along x in elastic equilibrium, so soft in shear that it counts.
std::unique_ptr<Analysis> analysis_of(const std::string& gravity, const std::string& joints,
                                      const std::vector<std::string>& responses) {
  std::string list;
  for (std::size_t i = 0; i < responses.size(); ++i) {
    list += fmt::format(R"({}"r{}": {})", i == 0 ? "" : ", ", i, responses[i]);
  }
  const ProblemFile problem = problem_from(fmt::format(R"({{"scene": {{"gravity": {},
            "materials": {{"steel": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
            "bodies": {{"beam": {{"type": "beam", "from": [0, 0, 0], "to": [0.5, 0, 0],
              "material": "steel", "elements": 3, "shear": true,
              "section": {{"type": "general", "area": 0.02, "inertia_y": 7e-5, "inertia_z": 7e-5,
                "torsion": 1e-4, "shear_area_y": 0.004, "shear_area_z": 0.004,
                "points": [{{"y": 0.1, "z": 0, "shear": 0}}]}}}}}},
            "joints": {}}},
          "effects": {{"rotary_inertia": "off", "geometric_stiffening": "off"}},
          "simulation": {{"end_time": 2e-9, "step": 1e-9, "initial_state": "quasi-static"}},
          "responses": {{{}}}}})",
                                                       gravity, joints, list));
  return analyze(problem, start_design(problem));
}

std::string force_at(double share, const char* part) {
  return fmt::format(
      R"({{"type": "section-force", "body": "beam", "at": {}, "part": "{}", "over_time": "max-abs"}})",
      share, part);
}

double value(const Analysis& analysis, std::size_t response) {
  return std::abs(analysis.reductions[response].value);
}

/// Clamped at one end, on a roller at the other, under its weight q: the roller's force R holds
///     q L⁴/8EI + q L²/2κGA = R (L³/3EI + L/κGA)
TEST(ForcesOfAShearedBeam, HeldTwiceAreTimoshenkos) {
  const auto found =
      analysis_of("[0, -9.81, 0]",
                  R"({"clamp": {"type": "fixed", "bodies": ["ground", "beam"], "at": [0, 0, 0]},
          "roller": {"type": "point-on-line", "bodies": ["ground", "beam"], "at": [0.5, 0, 0],
                     "axis": [1, 0, 0]}})",
                  {force_at(0.0, "moment-z"), force_at(0.6, "moment-z"), force_at(0.6, "shear-y"),
                   R"({"type": "reaction-force", "joint": "roller", "direction": "y",
                      "over_time": "max-abs"})"});
  const double q = 9.81 * density * area, L = length;
  const double bending = 1 / (young * inertia), shear = 1 / (shear_modulus * shear_area);
  const double R = q * (std::pow(L, 4) / 8 * bending + L * L / 2 * shear) /
                   (std::pow(L, 3) / 3 * bending + L * shear);
  ASSERT_GT(R, 1.1 * 3 * q * L / 8);  // not that of a beam without shear
  const double rest = 0.4 * L;        // from the cut to the roller
  const double expected[] = {q * L * L / 2 - R * L, R * rest - q * rest * rest / 2, R - q * rest,
                             R};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(value(*found, i), std::abs(expected[i]), 1e-6 * R) << i;
  }
}

/// Turned with the acceleration α: M = ρAα (L³/3 − x L²/2 + x³/6), V = ρAα (L² − x²)/2. Loads that
/// grow along an element are held by moments that depend on shear, and the strain of its nodes is
/// without them.
TEST(ForcesOfAShearedBeam, UnderALoadThatGrowsAreThoseOfStatics) {
  const auto found = analysis_of(
      "[0, 0, 0]",
      R"({"hinge": {"type": "revolute", "bodies": ["ground", "beam"], "at": [0, 0, 0],
                    "axis": [0, 0, 1], "drive": {"type": "polynomial", "coefficients": [0, 0, 5]}}})",
      {force_at(0.0, "moment-z"), force_at(0.45, "moment-z"), force_at(0.45, "shear-y")});
  const double load = density * area * 10.0, L = length, x = 0.45 * L;
  const double moment = load * (L * L * L / 3 - x * L * L / 2 + x * x * x / 6);
  EXPECT_NEAR(value(*found, 0), load * L * L * L / 3, 1e-6 * load);
  EXPECT_NEAR(value(*found, 1), moment, 1e-6 * load);
  EXPECT_NEAR(value(*found, 2), load * (L * L - x * x) / 2, 1e-6 * load);
}

/// Engesser: P/(1 + P/κGA).
TEST(EulerLoad, OfAShearedBeamIsEngessers) {
  const auto found = analysis_of(
      "[0, 0, 0]", R"({"clamp": {"type": "fixed", "bodies": ["ground", "beam"], "at": [0, 0, 0]}})",
      {R"({"type": "mass"})"});
  const double euler = std::pow(std::numbers::pi / length, 2) * young * inertia;
  const double expected = euler / (1 + euler / (shear_modulus * shear_area));
  const auto loads = euler_loads(found->model.body("beam"), 0);
  ASSERT_EQ(loads.size(), 1u);
  EXPECT_NEAR(loads[0].value, expected, 1e-12 * expected);
  EXPECT_LT(expected, 0.5 * euler);
}

}  // namespace
}  // namespace pleuel::test::sheared_forces_test
