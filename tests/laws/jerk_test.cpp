/// Jerks: rates of accelerations.

#include <gmock/gmock.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/trust/fast_laws.hpp"
#include "sensitivity/gradients.hpp"
#include "sensitivity/sampled_gradients.hpp"
#include "tests/laws/law_gradients.hpp"
#include "tests/laws/law_problems.hpp"
#include "tests/support/differences.hpp"

namespace pleuel::test::jerk_test {
namespace {

using testing::HasSubstr;

/// A carriage with the motion c t³ and a wheel on it with the angle c t³, c = 2.
ProblemFile cubic_motion(const std::vector<std::string>& changes = {}) {
  return read_problem_text(R"({"scene": {"bodies": {
    "carriage": {"type": "rigid", "at": [0, 0, 0], "mass": 1, "inertia": [1, 1, 1, 0, 0, 0]},
    "wheel": {"type": "rigid", "at": [0, 0, 0], "mass": 1, "inertia": [1, 1, 1, 0, 0, 0]}},
  "joints": {
    "rail": {"type": "prismatic", "bodies": ["ground", "carriage"], "at": [0, 0, 0],
              "axis": [1, 0, 0], "drive": {"type": "polynomial",
              "coefficients": [0, 0, 0, {"variable": "c"}]}},
    "hub": {"type": "revolute", "bodies": ["carriage", "wheel"], "at": [0, 0, 0],
             "axis": [0, 0, 1], "drive": {"type": "polynomial",
             "coefficients": [0, 0, 0, {"variable": "turn"}]}}}},
  "variables": {"c": {"start": 2, "lower": 1, "upper": 3},
                 "turn": {"start": 2, "lower": 1, "upper": 3}},
  "simulation": {"end_time": 0.5, "step": 0.01},
  "responses": {
    "jerk": {"type": "jerk", "body": "carriage", "direction": "x", "over_time": "max-abs"},
    "least": {"type": "jerk", "body": "carriage", "direction": [1, 0, 0], "over_time": "min"},
    "first": {"type": "jerk", "body": "carriage", "direction": "x", "to": 0.02,
               "over_time": "mean"},
    "turning": {"type": "angular-jerk", "body": "wheel", "direction": "z",
                 "over_time": "final"}},
  "objective": {"minimize": "jerk"}})",
                           "cubic.json", changes)
      .complete();
}

/// 6 c at all instants, the first and the last as well.
TEST(Jerk, OfACubicMotionIsConstant) {
  const ProblemFile problem = cubic_motion();
  const auto analysis = analyze(problem, start_design(problem));
  for (const Reduction& reduction : analysis->reductions) EXPECT_NEAR(reduction.value, 12.0, 1e-7);
  for (const ExactMethod method : {ExactMethod::direct, ExactMethod::adjoint}) {
    const Eigen::MatrixXd gradients =
        sampled_gradients(*analysis, response_values(*analysis), method);
    const Eigen::MatrixXd expected{{6.0, 0.0}, {6.0, 0.0}, {6.0, 0.0}, {0.0, 6.0}};
    EXPECT_LE((gradients - expected).cwiseAbs().maxCoeff(), 1e-6) << gradients;
  }
}

/// 20 (t − t₀)³: 120 m/s³, of which index 3 makes 159. Index 1 has it, but for the first step behind the
/// corner; the cubic that begins with the simulation has no corner.
TEST(Jerk, AtACornerOfADriveIsToldWhereItRings) {
  const std::string corner =
      R"(/scene/joints/rail/drive={"type": "expression",
         "value": "= c * 10 m/s^3 * max(0 s, t - 100 ms)^3"})";
  const ProblemFile ringing = cubic_motion({corner});
  const Eigen::VectorXd x = start_design(ringing);
  const auto analysis = analyze(ringing, x);
  EXPECT_GT(analysis->reductions[0].value, 1.2 * 120.0);
  const Monitors monitors = monitor(analysis->model, analysis->trajectory);
  const std::vector<Finding> found = check_jerks_at_corners({ringing, x, *analysis, monitors});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].is_serious);
  EXPECT_THAT(found[0].text, HasSubstr("the peak of the jerk \"jerk\" is at a corner"));
  EXPECT_THAT(found[0].text, HasSubstr("(t = 0.1 s)"));

  // A formula of it is no way around.
  const ProblemFile formula =
      cubic_motion({corner, R"(/responses/twice={"type": "expression", "value": "= 2 * jerk"})",
                    R"(/objective={"minimize": "twice"})"});
  const auto doubled = analyze(formula, x);
  EXPECT_EQ(check_jerks_at_corners({formula, x, *doubled, monitors}).size(), 1u);

  const ProblemFile calm = cubic_motion({corner, "/simulation/formulation=index-1"});
  const auto right = analyze(calm, x);
  EXPECT_NEAR(right->reductions[0].value, 120.0, 1e-6);
  EXPECT_TRUE(check_jerks_at_corners({calm, x, *right, monitors}).empty());

  const ProblemFile smooth = cubic_motion();
  const auto all = analyze(smooth, x);
  EXPECT_TRUE(check_jerks_at_corners({smooth, x, *all, monitors}).empty());
}

TEST(Jerk, HasNoMagnitudeOfItsOwn) {
  try {
    cubic_motion({"/responses/jerk/direction=\"magnitude\""});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the magnitude of the jerk is no rate of that of the "
                                        "acceleration"));
  }
}

/// The tip of a cantilever under a load that comes up: a peak between the steps, and the mean square.
TEST(Jerk, HasTheGradientOfItsSimulation) {
  const ProblemFile problem = loaded_cantilever(
      R"({"type": "ramp", "to": {"variable": "force"}, "begin": 0.02, "end": 0.06, "rounding": 0.01})",
      {R"(/responses/end={"type": "jerk", "body": "beam", "at": 1, "direction": "y",
          "over_time": "rms"})",
       R"(/responses/sag={"type": "jerk", "body": "beam", "at": 1, "direction": "y",
          "over_time": "max", "to": 0.05})",
       "/simulation/newton_tolerance=1e-13"});
  const auto [direct, adjoint, expected] = law_gradients(problem);
  EXPECT_LE(relative_difference(adjoint, direct), 1e-9);
  for (Eigen::Index i = 0; i < expected.rows(); ++i) {
    EXPECT_LE((direct.row(i) - expected.row(i)).norm(), 1e-5 * expected.row(i).norm()) << i;
  }
}

}  // namespace
}  // namespace pleuel::test::jerk_test
