/// Energy that is missing.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/trust/resolution.hpp"
#include "tests/core/trust/crank_rocker.hpp"
#include "tests/core/trust/findings_of.hpp"

namespace pleuel::test::energy_balance_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// Of the largest energy, one percent may be missing.
TEST(EnergyBalance, IsDoubtedAboveOnePercent) {
  const ProblemFile problem = read_scene(crank_rocker(driven, closed));
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  Monitors monitors = monitor(analysis->model, analysis->trajectory);
  monitors.energy_error = 0.0098;
  EXPECT_THAT(check_energy_balance(TrustedRun{problem, x, *analysis, monitors}), IsEmpty());
  monitors.energy_error = 0.0102;
  const auto findings = check_energy_balance(TrustedRun{problem, x, *analysis, monitors});
  ASSERT_THAT(findings, SizeIs(1));
  EXPECT_THAT(findings[0].text, HasSubstr("balanced to 1 % of"));
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

}  // namespace
}  // namespace pleuel::test::energy_balance_test
