#include "core/base/eager_matrices.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/gradients.hpp"
#include "sensitivity/method_choice.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::gradient_test {
namespace {

struct Case {
  std::string problem;
  std::vector<std::string> overrides;
};

class GradientsOfAProblem : public testing::TestWithParam<Case> {
 protected:
  GradientsOfAProblem() {
    std::vector<std::string> overrides = {"/simulation/end_time=0.072 s",
                                          "/simulation/step=1e-4 s"};
    overrides.insert(overrides.end(), GetParam().overrides.begin(), GetParam().overrides.end());
    problem_ = sample_problem(GetParam().problem, overrides);
    problem_.simulation.newton_tolerance = 1e-12;
    x_ = start_design(problem_);
    // Away from the start, where the peaks of the rod's bow nearly tie.
    for (Eigen::Index i = 0; i < x_.size(); ++i) x_(i) *= 0.75 - 0.03 * double(i % 3);
  }
  ProblemFile problem_;
  Eigen::VectorXd x_;
};

/// V-curve of central differences and of their extrapolation: at the best step, or the first that is
/// good enough, the error is ≤ 1e-7 of the largest entry (per relative change of a variable) for
/// peaks and ends, ≤ 1e-9 for mass and rms.
TEST_P(GradientsOfAProblem, AreThoseOfCentralDifferencesAtTheBestStep) {
  const auto analysis = analyze(problem_, x_);
  const Eigen::MatrixXd direct = direct_gradients(*analysis) * x_.asDiagonal();
  Eigen::VectorXd best = Eigen::VectorXd::Ones(direct.rows());
  // Positions hardly depend on the sections: what counts there is the round-off of the mechanism's
  // size (0.3 m) over the narrowest step.
  const double round_off = 1e-16 * 0.3 / 2.5e-5;
  Eigen::VectorXd allowed(direct.rows());
  for (Eigen::Index i = 0; i < direct.rows(); ++i) {
    const auto& response = problem_.responses[i];
    const bool is_smooth = response.is<MassResponse>() || response.over_time == OverTime::rms;
    allowed(i) = is_smooth ? 1e-9 : 1e-7;
  }
  const auto compare = [&](const Eigen::MatrixXd& differences) {
    for (Eigen::Index i = 0; i < direct.rows(); ++i) {
      const bool is_position = time_derivative_of(problem_.responses[i]) == TimeDerivative::none;
      const double error = (differences.row(i) - direct.row(i)).lpNorm<Eigen::Infinity>() -
                           (is_position ? round_off : 0.0);
      best(i) = std::min(best(i), std::max(error, 0.0) / direct.row(i).lpNorm<Eigen::Infinity>());
    }
  };
  for (double step : {1e-3, 5e-4, 5e-5}) {
    const Eigen::MatrixXd wide = central_differences(problem_, x_, step) * x_.asDiagonal();
    const Eigen::MatrixXd narrow = central_differences(problem_, x_, step / 2) * x_.asDiagonal();
    compare(wide);
    compare(narrow);
    compare((4 * narrow - wide) / 3);
    if ((best.array() <= allowed.array()).all()) break;
  }
  for (Eigen::Index i = 0; i < direct.rows(); ++i) {
    const auto& response = problem_.responses[i];
    const auto& ties = analysis->reductions[i].ties;
    EXPECT_TRUE(ties.empty()) << response.name << ": no kink may be here";
    EXPECT_LE(best(i), allowed(i)) << response.name;
  }
}

std::string case_name(const testing::TestParamInfo<Case>& info) {
  return info.param.problem;
}

INSTANTIATE_TEST_SUITE_P(
    Problems, GradientsOfAProblem,
    testing::Values(Case{"slider_crank",
                         {"/scene/bodies/crank/elements=3", "/scene/bodies/rod/elements=4"}},
                    Case{"slider_crank_round",
                         {"/scene/bodies/crank/elements=3", "/scene/bodies/rod/elements=4"}},
                    Case{"slider_crank_tapered", {"/simulation/end_time=0.06 s"}}),
    case_name);

/// A variable at 0 with a range of 2 mrad: y = 100 mm · sin(1000 p). A step of 1e-5 without regard
/// of the range would turn the arm by 0.01 rad and err by 0.01² / 6.
TEST(Differences, OfAVariableAtZeroTakeTheirStepFromItsRange) {
  const ProblemFile problem = problem_from(R"({
    "scene": {
      "bodies": {"arm": {"type": "beam", "from": [0, 0, 0], "to": ["100 mm", 0, 0], "rigid": true,
        "material": "steel", "elements": 2, "section": {"type": "circle", "diameter": "10 mm"}}},
      "joints": {"bearing": {"type": "revolute", "bodies": ["ground", "arm"], "at": [0, 0, 0],
        "drive": {"type": "constant", "value": {"variable": "p", "factor": 1000}}}}},
    "simulation": {"end_time": "2 ms", "step": "1 ms"},
    "variables": {"p": {"start": 0, "lower": -0.001, "upper": 0.001}},
    "responses": {"y": {"type": "position", "body": "arm", "at": 1, "direction": "y", "over_time": "final"}}})");
  const Eigen::VectorXd x = start_design(problem);
  EXPECT_NEAR(central_differences(problem, x, 1e-5)(0, 0), 100.0, 1e-5);
  EXPECT_NEAR(forward_differences(problem, x, *analyze(problem, x), 1e-5)(0, 0), 100.0, 1e-5);
}

/// Beyond a hundredth of the range the value counts.
TEST(Differences, TakeTheirStepFromTheValueElsewhere) {
  const DesignVariable variable{"x", 1.0, -2.0, 8.0, ""};
  EXPECT_EQ(step_scale(variable, -1.5), 1.5);
  EXPECT_DOUBLE_EQ(step_scale(variable, 0.01), 0.1);
  EXPECT_EQ(step_scale({"x", 0.0, 0.0, 0.0, ""}, 0.0), 1.0);
}

class MethodsOfAProblem : public testing::TestWithParam<const char*> {};

/// Every response of every problem file, as the file stands: the two methods share the step's
/// tangents and nothing else.
TEST_P(MethodsOfAProblem, AgreeToRoundOff) {
  const auto [problem, x, analysis] = AtStart(sample_problem(GetParam()));
  const auto values = response_values(*analysis);
  const Eigen::MatrixXd direct =
      sampled_gradients(*analysis, values, ExactMethod::direct) * x.asDiagonal();
  const Eigen::MatrixXd adjoint =
      sampled_gradients(*analysis, values, ExactMethod::adjoint) * x.asDiagonal();
  for (Eigen::Index i = 0; i < direct.rows(); ++i) {
    EXPECT_LE((adjoint - direct).row(i).lpNorm<Eigen::Infinity>(),
              1e-10 * direct.row(i).lpNorm<Eigen::Infinity>())
        << problem.responses[i].name;
  }
}

INSTANTIATE_TEST_SUITE_P(Problems, MethodsOfAProblem,
                         testing::Values("slider_crank", "slider_crank_round",
                                         "slider_crank_tapered", "four_bar", "spatial_slider_crank",
                                         "robot_arm"),
                         [](const auto& test) { return std::string(test.param); });

/// Nothing is measured where the numbers settle it.
TEST(ChoiceOfAMethod, IsDirectForFewVariablesAndManyValues) {
  const auto [problem, x, analysis] = AtStart(sample_problem("slider_crank_round"));
  const auto values = response_values(*analysis);
  ASSERT_GT(values.size(), problem.variables.size());
  const MethodChoice choice = choose_method(*analysis, values);
  EXPECT_EQ(choice.method, ExactMethod::direct);
  EXPECT_EQ(choice.reason.find("times"), std::string::npos) << choice.reason;
}

/// Measured times scatter by tens of percent.
TEST(ChoiceOfAMethod, IsTheAdjointIfThatIsClearlyFaster) {
  EXPECT_EQ(cheaper_method(2.0, 1.0), ExactMethod::adjoint);
  EXPECT_EQ(cheaper_method(1.1, 1.0), ExactMethod::direct);
  EXPECT_EQ(cheaper_method(1.0, 2.0), ExactMethod::direct);
}

/// One value of the motion, eight variables: both are measured. The gradient does not depend on
/// the choice.
TEST(ChoiceOfAMethod, LeavesTheGradientAsItIs) {
  ProblemFile problem = sample_problem("slider_crank_tapered");
  problem.responses.resize(2);  // the mass, and a stress
  problem.constraints.clear();
  const auto [x, analysis] = started(problem);
  const Eigen::MatrixXd automatic = gradients(problem, x, *analysis, GradientMethod::automatic);
  EXPECT_NE(choose_method(*analysis, response_values(*analysis)).reason.find("times"),
            std::string::npos);
  for (auto method : {GradientMethod::direct, GradientMethod::adjoint}) {
    const Eigen::MatrixXd other = gradients(problem, x, *analysis, method);
    EXPECT_LE((automatic - other).norm(), 1e-10 * other.norm()) << to_string(method);
  }
}

// Joints and loads that design variables move along elastic beams: nodes of the mesh follow them.

/// A bar of 2 m under its own weight q = ρ A g on two supports, a from either end.
ProblemFile bar_on_two_supports(double a) {
  return problem_from(fmt::format(R"j({{"scene": {{"gravity": [0, "-9.81 m/s^2", 0],
    "bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [2, 0, 0], "material": "steel", "elements": 8,
      "section": {{"type": "rectangle", "width": "40 mm", "height": "20 mm"}}}}}},
    "joints": {{
      "left": {{"type": "revolute", "bodies": ["ground", "bar"], "at": [{{"variable": "a"}}, 0, 0]}},
      "right": {{"type": "point-on-line", "bodies": ["ground", "bar"], "at": ["= 2 m - a", 0, 0],
                 "axis": [1, 0, 0]}}}}}},
  "simulation": {{"end_time": "2 ms", "step": "1 ms", "initial_state": "quasi-static"}},
  "variables": {{"a": {{"start": "{} m", "lower": "0.1 m", "upper": "0.9 m"}}}},
  "responses": {{
    "middle": {{"type": "section-force", "body": "bar", "part": "moment-z", "at": 0.5, "over_time": "final"}},
    "beside": {{"type": "section-force", "body": "bar", "part": "moment-z", "at": 0.25, "over_time": "final"}},
    "sag": {{"type": "position", "body": "bar", "at": 0.5, "direction": "y", "over_time": "final"}},
    "end": {{"type": "position", "body": "bar", "at": 0, "direction": "y", "over_time": "final"}}}}}})j",
                                  a));
}

/// With q the weight per length and l = 2 m − 2a between the supports, from statics and tables of beams:
///     M(x) = q x²/2 − (q L/2) (x − a),     dM/da = q L/2 between the supports
/// At a quarter there is a node between elements of different lengths.
///     v(L/2) = −q l² (5 l² − 24 a²)/(384 E I),   v(0) = −q a (6 a² l + 3 a³ − l³)/(24 E I)
TEST(MovingSupports, HaveTheDerivativesOfStatics) {
  const double q = 7850 * 0.04 * 0.02 * 9.81, bending = 210e9 * 0.04 * 8e-6 / 12, a = 0.3;
  const ProblemFile problem = bar_on_two_supports(a);
  const auto analysis = analyze(problem, start_design(problem));
  const Eigen::VectorXd values = values_of(*analysis);
  const Eigen::MatrixXd slopes = direct_gradients(*analysis);
  const auto moment = [&](double x) { return std::abs(q * x * x / 2 - q * (x - a)); };
  // Sections are turned by some 2e-3, of which the square counts.
  EXPECT_NEAR(std::abs(values(0)), moment(1.0), 1e-5 * moment(1.0));
  EXPECT_NEAR(std::abs(values(1)), moment(0.5), 1e-5 * moment(1.0));
  EXPECT_NEAR(std::abs(slopes(0, 0)), q, 1e-5 * q);
  EXPECT_NEAR(std::abs(slopes(1, 0)), q, 1e-5 * q);
  const auto sag = [&](double at) {
    const double l = 2 - 2 * at;
    return -q * l * l * (5 * l * l - 24 * at * at) / (384 * bending);
  };
  const auto end = [&](double at) {
    const double l = 2 - 2 * at;
    return -q * at * (6 * at * at * l + 3 * at * at * at - l * l * l) / (24 * bending);
  };
  // Against lines that are the axis of the bar at small slopes; 1e-4 of the second order.
  const auto slope = [&](const auto& of) { return (of(a + 1e-5) - of(a - 1e-5)) / 2e-5; };
  EXPECT_NEAR(values(2), sag(a), 1e-4 * std::abs(sag(a)));
  EXPECT_NEAR(values(3), end(a), 1e-4 * std::abs(sag(a)));
  EXPECT_NEAR(slopes(2, 0), slope(sag), 1e-4 * std::abs(slope(sag)));
  EXPECT_NEAR(slopes(3, 0), slope(end), 1e-4 * std::abs(slope(end)));
}

/// A driven arm of two stretches that carries a bob on a pin at s, is pushed at p, and begins bent at i.
struct Arm {
  const char *name, *keys, *push;
};
void PrintTo(const Arm& arm, std::ostream* stream) {
  *stream << arm.name;
}

ProblemFile loaded_arm(const Arm& arm) {
  return problem_from(fmt::format(R"j({{"scene": {{"gravity": [0, -9.81, 0],
    "bodies": {{
      "arm": {{"type": "beam", "from": [0, 0, 0], "to": [{{"variable": "L"}}, 0, 0], "material": "steel", {},
        "damping": {{"stiffness": "0.1 ms"}},
        "segments": [
          {{"elements": 2, "section": {{"type": "rectangle", "width": "20 mm", "height": {{"variable": "h"}}}}}},
          {{"elements": 4, "section": {{"type": "rectangle", "width": "18 mm", "height": "12 mm"}}}}],
        "initial_deflections": [{{"at": [{{"variable": "i"}}, 0, 0], "direction": [0, 1, 0], "displacement": "0.4 mm"}}]}},
      "bob": {{"type": "rigid", "at": [{{"variable": "s"}}, -0.1, 0], "mass": 0.4, "inertia": [1e-3, 1e-3, 1e-3, 0, 0, 0]}}}},
    "joints": {{
      "hub": {{"type": "revolute", "bodies": ["ground", "arm"], "at": [0, 0, 0],
               "drive": {{"type": "constant-speed", "speed": 40}}}},
      "pin": {{"type": "revolute", "bodies": ["arm", "bob"], "at": [{{"variable": "s"}}, 0, 0]}}}},
    "loads": {{"push": {{"type": "force", "body": "arm", "at": [{{"variable": "p"}}, 0, 0], "direction": {}, "follows": true,
                         "value": {{"type": "harmonic", "amplitude": 60, "frequency": 300}}}}}}}},
  "simulation": {{"end_time": "20 ms", "step": "0.1 ms", "newton_tolerance": 1e-12, "resolution_check": false}},
  "variables": {{
    "s": {{"start": 0.31, "lower": 0.28, "upper": 0.35}}, "p": {{"start": 0.1, "lower": 0.05, "upper": 0.15}},
    "i": {{"start": 0.45, "lower": 0.4, "upper": 0.5}}, "L": {{"start": 0.6, "lower": 0.55, "upper": 0.65}},
    "h": {{"start": 0.02, "lower": 0.01, "upper": 0.03}}}},
  "responses": {{
    "tip": {{"type": "deflection", "body": "arm", "at": 1, "over_time": "rms"}},
    "inside": {{"type": "deflection", "body": "arm", "at": 0.47, "direction": "y", "over_time": "final"}},
    "between": {{"type": "velocity", "body": "arm", "at": 0.27, "direction": "x", "over_time": "final"}},
    "moment": {{"type": "section-force", "body": "arm", "part": "moment-z", "at": 0.4, "over_time": "rms"}},
    "shear": {{"type": "section-force", "body": "arm", "part": "shear-y", "at": 0.9, "over_time": "final"}},
    "stress": {{"type": "stress", "body": "arm", "over_time": "final"}},
    "pull": {{"type": "reaction-force", "joint": "pin", "direction": "x", "over_time": "final"}},
    "frequency": {{"type": "frequency", "body": "arm"}},
    "energy": {{"type": "elastic-energy", "over_time": "mean"}}}}}})j",
                                  arm.keys, arm.push));
}

class MovingPlaces : public testing::TestWithParam<Arm> {};

/// Direct differentiation, the adjoint, and central differences of fourth order.
TEST_P(MovingPlaces, HaveTheDerivativesOfDifferences) {
  const auto [problem, x, analysis] = AtStart(loaded_arm(GetParam()));
  const auto values = response_values(*analysis);
  const Eigen::MatrixXd direct = sampled_gradients(*analysis, values, ExactMethod::direct);
  const Eigen::MatrixXd adjoint = sampled_gradients(*analysis, values, ExactMethod::adjoint);
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const double step = 3e-4 * x(k);
    const auto at = [&, &problem = problem, &x = x](double factor) {
      Eigen::VectorXd moved = x;
      moved(k) += factor * step;
      return values_of(*analyze(problem, moved));
    };
    const Eigen::VectorXd differences =
        (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * step);
    for (Eigen::Index i = 0; i < direct.rows(); ++i) {
      const double scale = direct.row(i).cwiseProduct(x.transpose()).lpNorm<Eigen::Infinity>();
      EXPECT_NEAR(direct(i, k) * x(k), differences(i) * x(k), 2e-6 * scale)
          << problem.responses[i].name << " by " << problem.variables[k].name;
      EXPECT_NEAR(direct(i, k) * x(k), adjoint(i, k) * x(k), 1e-8 * scale)
          << problem.responses[i].name << " by " << problem.variables[k].name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Arms, MovingPlaces,
    testing::Values(Arm{"tangent", R"("frame": "tangent")", "[0, 1, 0]"},
                    Arm{"chord", R"("frame": "chord", "shear": true)", "[0, 1, 0]"},
                    Arm{"mean_axis", R"("frame": "mean-axis")", "[0, 1, 0]"},
                    Arm{"reduced", R"("frame": "tangent", "reduction": {"modes": 4})", "[0, 1, 0]"},
                    Arm{"space", R"("frame": "tangent")", "[0, 0.6, 0.8]"}),
    [](const auto& test) { return std::string(test.param.name); });

class AnalysisOfValuesOnly : public testing::TestWithParam<const char*> {};

/// Values first, derivatives later: the same digits as at once, wherever the states are. Nothing is
/// differentiated that has no derivatives, which would be zeros.
TEST_P(AnalysisOfValuesOnly, HasTheSameGradientsOnceItHasDerivatives) {
  const ProblemFile problem = sample_problem(
      "robot_arm",
      {fmt::format("/sensitivity/memory={}", GetParam()), "/simulation/end_time=0.02 s",
       R"(/responses/lowest={"type": "frequency"})",
       R"(/responses/off={"type": "deflection", "body": "forearm", "at": 1, "direction": "z",
                                      "against": "rigid-mechanism", "over_time": "rms"})"});
  const Eigen::VectorXd x = start_design(problem);
  const auto at_once = analyze(problem, x);
  auto later = analyze(problem, x, values_only);
  EXPECT_EQ(values_of(*later), values_of(*at_once));
  EXPECT_THROW(direct_gradients(*later), std::logic_error);
  later = with_derivatives(problem, std::move(later));
  EXPECT_EQ(direct_gradients(*later), direct_gradients(*at_once));
}

INSTANTIATE_TEST_SUITE_P(Memory, AnalysisOfValuesOnly, testing::Values("4 GB", "0.1 MB"),
                         [](const auto& test) {
                           return test.param[0] == '4' ? "HoldsAll" : "HoldsFew";
                         });

}  // namespace
}  // namespace pleuel::test::gradient_test
