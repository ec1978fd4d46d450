#include "core/base/eager_matrices.hpp"
#include "core/trust/joint_findings.hpp"
#include "core/trust/resolution.hpp"
#include "tests/core/trust/crank_rocker.hpp"
#include "tests/core/trust/findings_of.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::energy_balance_test {
namespace {

// Energy that is missing.

/// Of the largest energy, one percent may be missing.
TEST(EnergyBalance, IsDoubtedAboveOnePercent) {
  const ProblemFile problem = read_scene(crank_rocker(driven, closed));
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  Monitors monitors = monitor(analysis->model, analysis->trajectory);
  monitors.energy_error = 0.0098;
  EXPECT_THAT(check_energy_balance(TrustedRun{problem, x, *analysis, monitors}), IsEmpty());
  monitors.energy_error = 0.0102;
  const Finding finding = only(check_energy_balance(TrustedRun{problem, x, *analysis, monitors}));
  EXPECT_THAT(finding.text, HasSubstr("balanced to 1 % of"));
}

/// What does not move has no energy to be balanced: the last digits of its potential are none.
TEST(EnergyBalance, IsNotDoubtedWhereNothingMoves) {
  const ProblemFile problem = read_scene(R"({"scene": {
      "gravity": [1.336, 8.616, -4.495],
      "bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": [0.0525, -0.3823, 0.2024],
                         "material": "steel", "rigid": true, "elements": 1,
                         "section": {"type": "circle", "diameter": 0.02}}},
      "joints": {"wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}}},
    "simulation": {"end_time": 0.15, "step": 0.0007673},
    "responses": {"mass": {"type": "mass"}}})");
  EXPECT_THAT(findings_of(problem, check_energy_balance), IsEmpty());
}

/// An error of a small vibration is not hidden by where a scene stands.
TEST(EnergyBalance, IsAskedOfSmallMotionsFarFromTheOrigin) {
  const auto error_at = [](double height) {
    const ProblemFile problem = read_scene(fmt::format(
        R"({{"scene": {{"gravity": [0, -9.81, 0],
              "bodies": {{"block": {{"type": "rigid", "at": [0, {0}, 0], "mass": 1,
                                    "inertia": [1, 1, 1, 0, 0, 0], "velocity": [1e-3, 0, 0]}}}},
              "joints": {{"guide": {{"type": "prismatic", "bodies": ["ground", "block"],
                                    "at": [0, {0}, 0], "axis": [1, 0, 0]}}}},
              "loads": {{"spring": {{"type": "joint", "joint": "guide", "stiffness": 1e4}}}}}},
            "simulation": {{"end_time": 0.2, "step": 0.01, "spectral_radius": 0.5}},
            "responses": {{"mass": {{"type": "mass"}}}}}})",
        height));
    const auto analysis = analyze(problem, start_design(problem));
    return monitor(analysis->model, analysis->trajectory).energy_error;
  };
  const double near = error_at(0.0);
  EXPECT_GT(near, 0.02);
  EXPECT_NEAR(error_at(1000.0), near, 0.01 * near);
}

/// A shaft along x in two bearings, 100 mm apart, with a pull along y beyond the second one.
std::vector<Finding> findings(const std::string& first, const std::string& second) {
  const ProblemFile shaft = read_scene(fmt::format(
      R"({{"scene": {{"gravity": [0, 0, 0], "bodies": {{
            "shaft": {{"type": "rigid", "at": [0.05, 0, 0], "mass": 1,
                       "inertia": [1e-3, 2e-3, 2e-3, 0, 0, 0]}}}},
          "joints": {{"one": {}, "other": {}}},
          "loads": {{"belt": {{"type": "force", "body": "shaft", "at": [0.13, 0, 0],
                               "direction": [0, 1, 0], "value": 500}}}}}},
          "simulation": {{"end_time": 0.01, "step": 0.001}},
          "responses": {{
            "one": {{"type": "reaction-force", "joint": "one", "direction": "y",
                     "over_time": "final"}},
            "other": {{"type": "reaction-force", "joint": "other", "direction": "y",
                       "over_time": "final"}},
            "speed": {{"type": "angular-velocity", "body": "shaft", "direction": "x",
                       "over_time": "max-abs"}}}}}})",
      first, second));
  return findings_of(shaft, check_undetermined_reactions);
}

std::string bearing(const std::string& type, double at) {
  const std::string axis = type == "spherical" ? "" : R"(, "axis": [1, 0, 0])";
  return fmt::format(R"({{"type": "{}", "bodies": ["ground", "shaft"], "at": [{}, 0, 0]{}}})", type,
                     at, axis);
}

/// Two hinges hold the tilt of the shaft twice: 650 and −150 N follow only where each holds forces
/// alone.
TEST(UndeterminedReactions, OfTwoHingesAreTold) {
  const Finding found = only(findings(bearing("revolute", 0.1), bearing("revolute", 0.0)));
  EXPECT_THAT(found.responses, UnorderedElementsAre("one", "other"));
  EXPECT_FALSE(found.is_serious);
  // Nor where only one of them holds the tilt, and the other one the way of its end.
  EXPECT_THAT(findings(bearing("revolute", 0.1), bearing("spherical", 0.0)), SizeIs(1));
}

TEST(UndeterminedReactions, AreNoneOfBearingsThatHoldForces) {
  EXPECT_THAT(findings(bearing("point-on-line", 0.1), bearing("spherical", 0.0)), IsEmpty());
}

}  // namespace
}  // namespace pleuel::test::energy_balance_test
