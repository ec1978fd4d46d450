/// Frequencies of mechanisms with bodies that spin, and their derivatives.

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"
#include "sensitivity/gradients.hpp"

namespace pleuel::test::whirl_test {
namespace {

/// A top of 2 kg that hangs at a length below a ball joint and spins about the vertical.
const char* const hanging_top = R"j({"scene": {"gravity": [0, -9.81, 0],
    "bodies": {"top": {"type": "rigid", "at": [0, "= -1 * length", 0], "mass": "= mass",
      "inertia": [0.012, 0.02, 0.012, 0, 0, 0], "angular_velocity": [0, "= spin", 0]}},
    "joints": {"pivot": {"type": "spherical", "bodies": ["ground", "top"], "at": [0, 0, 0]}}},
  "effects": {"spatial_motion": "on"},
  "simulation": {"end_time": 1e-4, "step": 1e-4},
  "variables": {"length": {"start": "150 mm", "lower": "100 mm", "upper": "200 mm"},
                "mass": {"start": "2 kg", "lower": "1 kg", "upper": "3 kg"},
                "spin": {"start": "60 rad/s", "lower": "1 rad/s", "upper": "100 rad/s"}},
  "responses": {"slow": {"type": "frequency", "mode": 1}, "fast": {"type": "frequency", "mode": 2}}})j";

/// (I_d + m l²) ω² ∓ I_p Ω ω − m g l = 0, in axes that stand still
double whirl(const Eigen::Vector3d& x, double side) {
  const double l = x(0), m = x(1), momentum = 0.02 * x(2), inertia = 0.012 + m * l * l;
  return (side * momentum + std::sqrt(momentum * momentum + 4 * inertia * m * 9.81 * l)) /
         (2 * inertia);
}

TEST(Whirl, OfATopIsTheClosedFormWithItsDerivatives) {
  const ProblemFile problem = read_problem_text(hanging_top, "top.json").complete();
  const Eigen::Vector3d x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const Eigen::MatrixXd gradients = direct_gradients(*analysis);
  for (int i = 0; i < 2; ++i) {
    const double side = i == 0 ? -1.0 : 1.0;
    EXPECT_NEAR(analysis->reductions[i].value, whirl(x, side), 1e-9 * whirl(x, side));
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d step = 1e-4 * x(k) * Eigen::Vector3d::Unit(k);
      const double slope = (whirl(x + step, side) - whirl(x - step, side)) / 2e-4;
      EXPECT_NEAR(gradients(i, k) * x(k), slope, 1e-6 * whirl(x, side)) << i << " " << k;
    }
  }
}

}  // namespace
}  // namespace pleuel::test::whirl_test
