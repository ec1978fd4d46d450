#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/response/analysis.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

/// Drives whose acceleration jumps, or has a corner.

namespace pleuel::test::corner_test {
namespace {

/// A mass of 2 kg on a line: what moves it is F = m s̈.
std::string pushed(const std::string& displacement, const std::string& formulation) {
  return fmt::format(
      R"({{"scene": {{
          "bodies": {{"mass": {{"type": "point-mass", "at": [0, 0, 0], "mass": 2}}}},
          "joints": {{"guide": {{"type": "point-on-line", "bodies": ["ground", "mass"],
            "at": [0, 0, 0], "axis": [1, 0, 0], "drive": {{"type": "expression", "value": "= {}"}}}}}}}},
        "simulation": {{"end_time": 0.1, "step": 1e-3, "formulation": "{}"}},
        "responses": {{"force": {{"type": "drive-force", "joint": "guide", "over_time": "max"}}}}}})",
      displacement, formulation);
}

/// Of the force, away from the corner at 40 ms and the start.
double largest_error(const std::string& displacement, const std::string& formulation,
                     const std::function<double(double)>& acceleration) {
  const AtStart run(problem_from(pushed(displacement, formulation)));
  const Eigen::VectorXd& time = run.analysis->trajectory.time;
  double largest = 0.0;
  for (Eigen::Index i = 1; i < time.size(); ++i) {
    if (std::abs(time(i) - 0.04) < 1e-9) continue;
    const double exact = 2.0 * acceleration(time(i));
    largest = std::max(largest, std::abs(run.analysis->histories[0](0, i) - exact));
  }
  return largest;
}

class Corner : public testing::TestWithParam<const char*> {};

/// Schemes are exact for constant accelerations and jerks, before a corner and behind it: forces of
/// 4 N and up to 1.4 N are met to round-off (of positions of millimetres over h²). Without what the jumps change
/// they zigzag by 4 N and 0.02 N.
TEST_P(Corner, LeavesNoZigzagBehind) {
  EXPECT_LE(largest_error("1 m*max(0, t/(1 s) - 0.04)^2", GetParam(),
                          [](double t) { return t > 0.04 ? 2.0 : 0.0; }),
            1e-7);
  EXPECT_LE(largest_error("2 m*max(0, t/(1 s) - 0.04)^3", GetParam(),
                          [](double t) { return 12.0 * std::max(0.0, t - 0.04); }),
            1e-7);
}

/// An instant that a law has twice is one.
TEST_P(Corner, MayOccurTwiceInAFormula) {
  EXPECT_LE(largest_error("1 m*max(0, t/(1 s) - 0.04)^2 - 1 m*max(0, t/(1 s) - 0.04)^3", GetParam(),
                          [](double t) { return t > 0.04 ? 2.0 - 6.0 * (t - 0.04) : 0.0; }),
            0.05);
}

INSTANTIATE_TEST_SUITE_P(Formulations, Corner, testing::Values("index-3", "stabilized-index-2"),
                         [](const auto& test) {
                           return std::string(test.param).starts_with("index") ? "Index3"
                                                                               : "Index2";
                         });

/// A corner of 1 m/s² beside a wheel that swings by 1 rad with 100 rad/s: 2 N, not twice as many.
TEST(CornerBesideAFastDrive, IsFound) {
  const AtStart run(problem_from(R"({"scene": {
      "bodies": {"mass": {"type": "point-mass", "at": [0, 0, 0], "mass": 2},
        "wheel": {"type": "rigid", "at": [0, 1, 0], "mass": 1, "inertia": [1, 1, 1, 0, 0, 0]}},
      "joints": {"guide": {"type": "point-on-line", "bodies": ["ground", "mass"], "at": [0, 0, 0],
          "axis": [1, 0, 0], "drive": {"type": "expression", "value": "= 0.5 m*max(0, t/(1 s) - 0.04)^2"}},
        "axle": {"type": "revolute", "bodies": ["ground", "wheel"], "at": [0, 1, 0], "axis": [0, 0, 1],
          "drive": {"type": "harmonic", "amplitude": 1, "frequency": 100}}}},
    "simulation": {"end_time": 0.1, "step": 1e-3},
    "responses": {"force": {"type": "drive-force", "joint": "guide", "over_time": "max"}}})"));
  EXPECT_NEAR(run.analysis->reductions[0].value, 2.0, 1e-6);
}

/// A flexible crank and rod, turned by a law that two variables shape: its acceleration jumps, as a
/// spline ends within the motion, and has corners; the slider's mass is the third.
ProblemFile turned_crank(const std::vector<std::string>& overrides = {}) {
  const std::string beam =
      R"("type": "beam", "material": "steel", "elements": 2, "damping": {"stiffness": 1e-5},
         "section": {"type": "rectangle", "width": 0.01, "height": 0.02})";
  return problem_from(fmt::format(
                          R"({{"scene": {{
              "bodies": {{"crank": {{{0}, "from": [0, 0, 0], "to": [0.12, 0, 0]}},
                "rod": {{{0}, "from": [0.12, 0, 0], "to": [0.3, 0, 0], "frame": "chord"}},
                "slider": {{"type": "point-mass", "at": [0.3, 0, 0], "mass": {{"variable": "mass"}}}}}},
              "joints": {{"bearing": {{"type": "revolute", "bodies": ["ground", "crank"],
                  "at": [0, 0, 0], "axis": [0, 0, 1], "drive": {{"type": "table",
                    "interpolation": "spline", "times": [0, 0.02, 0.05, 0.07],
                    "values": [0.4, {{"variable": "first"}}, {{"variable": "second"}}, 2.0]}}}},
                "pin": {{"type": "revolute", "bodies": ["crank", "rod"], "at": [0.12, 0, 0], "axis": [0, 0, 1]}},
                "end": {{"type": "revolute", "bodies": ["rod", "slider"], "at": [0.3, 0, 0], "axis": [0, 0, 1]}},
                "guide": {{"type": "point-on-line", "bodies": ["ground", "slider"], "at": [0.3, 0, 0], "axis": [1, 0, 0]}}}}}},
            "simulation": {{"end_time": 0.1, "step": 5e-4, "newton_tolerance": 1e-13}},
            "variables": {{"mass": {{"start": 0.3, "lower": 0.1, "upper": 1}},
              "first": {{"start": 0.7, "lower": 0.1, "upper": 1}},
              "second": {{"start": 1.6, "lower": 1, "upper": 3}}}},
            "responses": {{"torque": {{"type": "drive-torque", "joint": "bearing", "over_time": "rms"}},
              "late": {{"type": "drive-torque", "joint": "bearing", "over_time": "final"}},
              "bow": {{"type": "deflection", "body": "rod", "at": 0.5, "over_time": "rms"}},
              "stress": {{"type": "stress", "body": "crank", "over_time": "rms"}}}}}})",
                          beam),
                      overrides);
}

/// Direct differentiation is the adjoint to round-off, and both are central differences to their
/// error (1e-6 of a relative step of 1e-5).
TEST(GradientsBehindCorners, AreThoseOfDifferences) {
  for (const char* formulation : {"index-3", "stabilized-index-2"}) {
    const ProblemFile problem =
        turned_crank({fmt::format("/simulation/formulation={}", formulation)});
    const AtStart run(problem);
    EXPECT_EQ(run.analysis->trajectory.corners.size(), 3u);
    const Eigen::MatrixXd direct = direct_gradients(*run.analysis) * run.x.asDiagonal(),
                          adjoint =
                              gradients(problem, run.x, *run.analysis, GradientMethod::adjoint) *
                              run.x.asDiagonal(),
                          differences =
                              central_differences(problem, run.x, 1e-5) * run.x.asDiagonal();
    for (Eigen::Index i = 0; i < direct.rows(); ++i) {
      const double size = direct.row(i).lpNorm<Eigen::Infinity>();
      EXPECT_LE((direct - adjoint).row(i).lpNorm<Eigen::Infinity>(), 1e-10 * size) << i;
      EXPECT_LE((direct - differences).row(i).lpNorm<Eigen::Infinity>(), 1e-6 * size) << i;
    }
  }
}

/// A cylinder that lifts a boom: what it prescribes is multiplied with positions and speeds.
TEST(GradientsBehindCorners, OfALengthAreThoseOfDifferences) {
  const ProblemFile problem = problem_from(R"({"scene": {"gravity": [0, -9.81, 0],
      "bodies": {"boom": {"type": "rigid", "at": [1, 0, 0], "mass": 100, "inertia": [30, 30, 30, 0, 0, 0]}},
      "joints": {"pin": {"type": "revolute", "bodies": ["ground", "boom"], "at": [0, 0, 0], "axis": [0, 0, 1]},
        "cylinder": {"type": "distance", "bodies": ["ground", "boom"], "at": [{"variable": "foot"}, -0.5, 0],
          "to": [0.6, 0, 0], "drive": {"type": "table", "interpolation": "spline",
            "times": [0, 0.2, 0.5, 0.8], "values": [0, 0.02, 0.06, {"variable": "stroke"}]}}}},
    "simulation": {"end_time": 0.82, "step": 5e-3, "newton_tolerance": 1e-13},
    "variables": {"foot": {"start": 0.2, "lower": 0.1, "upper": 0.3},
      "stroke": {"start": 0.09, "lower": 0, "upper": 0.3}},
    "responses": {"force": {"type": "drive-force", "joint": "cylinder", "over_time": "final"},
      "all": {"type": "drive-force", "joint": "cylinder", "over_time": "rms"}}})");
  const AtStart run(problem);
  const Eigen::MatrixXd direct = direct_gradients(*run.analysis),
                        adjoint = gradients(problem, run.x, *run.analysis, GradientMethod::adjoint),
                        differences = central_differences(problem, run.x, 1e-4);
  for (Eigen::Index i = 0; i < direct.rows(); ++i) {
    const double size = direct.row(i).lpNorm<Eigen::Infinity>();
    EXPECT_LE((direct - adjoint).row(i).lpNorm<Eigen::Infinity>(), 1e-9 * size) << i;
    EXPECT_LE((direct - differences).row(i).lpNorm<Eigen::Infinity>(), 1e-4 * size) << i;
  }
}

/// Where memory holds only a few states, those behind a corner are made again, too.
TEST(StatesBehindCorners, AreTheSameWhenSimulatedAgain) {
  const AtStart all(turned_crank()), few(turned_crank({"/sensitivity/memory=0.05 MB"}));
  ASSERT_NE(few.analysis->trajectory.recomputed(), nullptr);
  EXPECT_EQ(direct_gradients(*few.analysis), direct_gradients(*all.analysis));
}

/// Of the torque of a crank without elasticity, 5 ms behind a corner.
double order_behind(double corner) {
  const auto torque = [&](int steps) {
    const double end = corner + 0.005;
    const AtStart run(turned_crank(
        {R"(/effects/elasticity="off")", fmt::format("/simulation/end_time={}", end),
         fmt::format("/simulation/step={}", end / steps),
         R"(/responses={"late": {"type": "drive-torque", "joint": "bearing", "over_time": "final"}})"}));
    return run.analysis->reductions[0].value;
  };
  const int steps = static_cast<int>(std::lround((corner + 0.005) / 2.5e-4));
  const double exact = torque(16 * steps);
  std::vector<double> sizes, errors;
  for (const int refined : {1, 2, 4}) {
    sizes.push_back(1.0 / refined);
    errors.push_back(std::abs(torque(refined * steps) - exact));
  }
  return observed_order(sizes, errors);
}

/// Steps err by the square of their size behind a jump of the jerk.
TEST(TorqueBehindACorner, IsOfSecondOrder) {
  EXPECT_NEAR(order_behind(0.05), 2.0, 0.2);
}

}  // namespace
}  // namespace pleuel::test::corner_test
