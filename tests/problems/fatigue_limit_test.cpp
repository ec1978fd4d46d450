#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/scene/problem_reader.hpp"
#include "optimization/design/design_solve.hpp"
#include "optimization/design/peak_problem.hpp"

/// A limit on fatigue decides an optimum.
namespace pleuel::test::fatigue_limit_test {
namespace {

/// A light bar in two segments, pulled by 3 kN + 2 kN sin ωt at its end and by as much at the end of
/// the first segment: 6 kN and 4 kN in the first one.
ProblemFile stepped_bar() {
  return read_problem_text(
             R"j({"scene": {"gravity": [0, 0, 0],
    "materials": {"light": {"young": "200 GPa", "poisson": 0.3, "density": 1,
      "ultimate_strength": "400 MPa", "endurance_limit": "100 MPa"}},
    "bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": [0.5, 0, 0], "material": "light",
      "segments": [
        {"section": {"type": "rectangle", "width": {"variable": "a"}, "height": "10 mm"},
         "elements": 1},
        {"section": {"type": "rectangle", "width": {"variable": "b"}, "height": "10 mm"},
         "elements": 1}]}},
    "joints": {"wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}},
    "loads": {
      "pull": {"type": "force", "body": "bar", "at": [0.5, 0, 0], "direction": [1, 0, 0],
               "value": "3 kN"},
      "shake": {"type": "force", "body": "bar", "at": [0.5, 0, 0], "direction": [1, 0, 0],
                "value": {"type": "harmonic", "amplitude": "2 kN", "frequency": "10 Hz"}},
      "pull_2": {"type": "force", "body": "bar", "at": [0.25, 0, 0], "direction": [1, 0, 0],
               "value": "3 kN"},
      "shake_2": {"type": "force", "body": "bar", "at": [0.25, 0, 0], "direction": [1, 0, 0],
                "value": {"type": "harmonic", "amplitude": "2 kN", "frequency": "10 Hz"}}}},
  "effects": {"geometric_stiffening": "off"},
  "simulation": {"end_time": "0.1 s", "step": "1 ms", "initial_state": "quasi-static",
                 "resolution_check": false},
  "variables": {"a": {"start": "20 mm", "lower": "1 mm", "upper": "50 mm"},
                "b": {"start": "20 mm", "lower": "1 mm", "upper": "50 mm"}},
  "responses": {"mass": {"type": "mass"},
                "life": {"type": "fatigue", "body": "bar", "criterion": "goodman"}},
  "objective": {"minimize": "mass"},
  "constraints": {"life": {"response": "life", "upper": 0.5}}})j",
             "stepped.json")
      .complete();
}

/// One limit on the whole beam is one on each of its segments, but not on windows of time.
TEST(FatigueLimit, IsDividedBySegmentsOnly) {
  DesignProblem design(stepped_bar());
  PeakProblem peaks(design, 4);
  EXPECT_EQ(peaks.constraints().size(), 2U);
  const Eigen::VectorXd x = Eigen::Vector2d(0.02, 0.01);
  const Evaluation at = peaks.evaluate(x, Request::values_and_gradients);
  // σ_a/S_e + σ_m/S_u of 200 mm² and of 100 mm².
  EXPECT_NEAR(at.constraints(0), 4e3 / 2e-4 / 100e6 + 6e3 / 2e-4 / 400e6, 1e-4);
  EXPECT_NEAR(at.constraints(1), 2e3 / 1e-4 / 100e6 + 3e3 / 1e-4 / 400e6, 1e-4);
  EXPECT_NEAR(at.constraint_jacobian(0, 0) * 0.02, -at.constraints(0), 1e-3);
  EXPECT_NEAR(at.constraint_jacobian(1, 1) * 0.01, -at.constraints(1), 1e-3);
  EXPECT_NEAR(at.constraint_jacobian(0, 1) * 0.01, 0.0, 1e-3);
}

/// Both segments at their limit: A = (F_a/S_e + F_m/S_u)/0.5, 110 mm² and 55 mm².
TEST(FatigueLimit, SizesBothSegments) {
  DesignProblem design(stepped_bar());
  const Result result = solve_design(design, SolveOptions());
  EXPECT_EQ(result.status, Status::verified) << result.message;
  EXPECT_NEAR(result.x(0) * 0.01, (4e3 / 100e6 + 6e3 / 400e6) / 0.5, 1e-8);
  EXPECT_NEAR(result.x(1) * 0.01, (2e3 / 100e6 + 3e3 / 400e6) / 0.5, 1e-8);
}

}  // namespace
}  // namespace pleuel::test::fatigue_limit_test
