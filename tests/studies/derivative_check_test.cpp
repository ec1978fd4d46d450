#include "studies/derivative_check.hpp"

#include "core/base/eager_matrices.hpp"
#include "core/base/relative_error.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/sampled_gradients.hpp"
#include "studies/noise.hpp"
#include "tests/studies/quick_problem.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::derivative_check_test {
namespace {

TEST(DerivativeCheck, AgreesForEveryResponseOfASampleProblem) {
  const auto [problem, x, analysis] = AtStart(test::quick_problem());
  const auto checks = check_derivatives(problem, x, *analysis);
  ASSERT_EQ(checks.responses.size(), problem.responses.size());
  ASSERT_EQ(checks.directions.size(), 1u);
  EXPECT_EQ(checks.directions[0].variables.size(), problem.variables.size());
  for (std::size_t i = 0; i < checks.responses.size(); ++i) {
    SCOPED_TRACE(problem.responses[i].name);
    // Differences of simulations with round-off 1e-12 reach 1e-8; what `check` allows is 1e-6.
    EXPECT_LT(checks.responses[i].worst().error, 1e-6);
    EXPECT_EQ(checks.responses[i].worst().verdict, DerivativeVerdict::agrees);
    EXPECT_LT(checks.responses[i].adjoint_error, 1e-10);  // both are exact
  }
}

/// Five soft links that swing: round-off grows with the motion. A design that is changed in its
/// last digits changes its own gradient by 2e-10 here, and the adjoint is not farther off than some
/// tens of that. (A wrong term would be 1e-3 and more.)
TEST(DerivativeCheck, FindsDirectAndAdjointAsFarApartAsRoundOffMovesTheMotion) {
  std::string bodies, joints;
  for (int i = 0; i < 5; ++i) {
    const std::string width = i == 1 ? R"({"variable": "w"})" : "\"10 mm\"";
    const std::string before = i == 0 ? "ground" : fmt::format("b{}", i - 1);
    const std::string drive =
        i == 0 ? R"(, "drive": {"type": "ramp-to-speed", "speed": 10, "ramp": 0.1})" : "";
    bodies += fmt::format(
        R"({0}"b{1}": {{"type": "beam", "from": [{2}, 0, 0], "to": [{3}, 0, 0], "material": "soft",
            "elements": 2, "frame": "chord", "damping": {{"stiffness": "1e-5 s"}},
            "section": {{"type": "rectangle", "width": {4}, "height": {{"variable": "h"}}}}}})",
        i == 0 ? "" : ", ", i, 0.2 * i, 0.2 * (i + 1), width);
    joints += fmt::format(
        R"({0}"j{1}": {{"type": "revolute", "bodies": ["{2}", "b{1}"], "at": [{3}, 0, 0], "axis": [0, 0, 1]{4}}})",
        i == 0 ? "" : ", ", i, before, 0.2 * i, drive);
  }
  const ProblemFile problem = problem_from(R"({"scene": {"gravity": [0, -9.81, 0],
          "materials": {"soft": {"young": "2 GPa", "poisson": 0.3, "density": 1200}},
          "bodies": {)" + bodies + R"(}, "joints": {)" +
                                           joints + R"(}},
          "simulation": {"end_time": "0.5 s", "step": "1 ms", "formulation": "stabilized-index-2"},
          "variables": {"h": {"start": 0.01, "lower": 0.005, "upper": 0.02},
            "w": {"start": 0.012, "lower": 0.005, "upper": 0.02}},
          "responses": {
            "a": {"type": "acceleration", "body": "b4", "at": 1, "direction": "y", "over_time": "max-abs"},
            "s": {"type": "stress", "body": "b0", "over_time": "max"}}})");
  const Eigen::VectorXd x = start_design(problem);
  const auto gradients = [&](const Eigen::VectorXd& design, ExactMethod method) {
    const auto analysis = analyze(problem, design);
    return sampled_gradients(*analysis, response_values(*analysis), method);
  };
  const Eigen::MatrixXd direct = gradients(x, ExactMethod::direct);
  const Eigen::MatrixXd adjoint = gradients(x, ExactMethod::adjoint);
  Eigen::VectorXd round_off = Eigen::VectorXd::Zero(direct.rows());
  for (const double change : {1e-15, -1e-15, 3e-15}) {
    const Eigen::MatrixXd moved = gradients((1.0 + change) * x, ExactMethod::direct);
    round_off = round_off.cwiseMax((moved - direct).rowwise().norm());
  }
  for (Eigen::Index i = 0; i < direct.rows(); ++i) {
    EXPECT_LE((adjoint.row(i) - direct.row(i)).norm(),
              100.0 * round_off(i) + 1e-10 * direct.row(i).norm())
        << problem.responses[i].name;
    EXPECT_LE(round_off(i), 1e-7 * direct.row(i).norm());  // or the law above says nothing
  }
}

/// An energy balance and a drift of constraints are what errors leave: differences of them say
/// nothing of the gradient where Newton's method is loose, and must not say that it is wrong.
TEST(DerivativeCheck, DoesNotBlameResponsesThatAreNoise) {
  const auto [problem, x, analysis] = AtStart(test::quick_problem(
      {"/simulation/newton_tolerance=1e-4", R"(/responses/balance={"type": "energy-balance"})",
       R"(/responses/drift={"type": "constraint-drift", "over_time": "max-abs"})",
       R"(/responses/rate={"type": "constraint-drift", "level": "velocity", "over_time": "max-abs"})"}));
  const auto checks = check_derivatives(problem, x, *analysis);
  for (std::size_t i = 0; i < checks.responses.size(); ++i) {
    const JudgedDerivative& worst = checks.responses[i].worst();
    EXPECT_NE(worst.verdict, DerivativeVerdict::differs)
        << problem.responses[i].name << ": " << worst.error;
  }
  const DerivativeCheck& balance = checks.responses.at(checks.responses.size() - 3);
  EXPECT_EQ(balance.worst().verdict, DerivativeVerdict::noise);
}

/// Newton's method stops after the same number of iterations at all designs nearby: what it leaves
/// is smooth in the design, and part of the differences but not of the gradient.
ProblemFile loose_problem(double tolerance = 1e-3) {
  return sample_problem("four_bar", {"/simulation/step=1 ms", "/simulation/end_time=30 ms",
                                     fmt::format("/simulation/newton_tolerance={}", tolerance)});
}

/// Central differences of two steps, extrapolated to none (Richardson): of fourth order, so that
/// steps can be long and round-off small.
Eigen::MatrixXd extrapolated_differences(const ProblemFile& problem, const Eigen::VectorXd& x) {
  const double step = 1e-3;
  return (4.0 * central_differences(problem, x, 0.5 * step) -
          central_differences(problem, x, step)) /
         3.0;
}

/// What the check below relies on. Single central differences come within some 1e-6 only: their
/// truncation, as the square of the step, meets their round-off, as its inverse, near 3e-5. What
/// the tolerance leaves in positions is some 1/h² as much in accelerations, and in stress.
TEST(DerivativeCheck, WouldFindTheDerivativesRightWithATightTolerance) {
  const ProblemFile problem = loose_problem(1e-13);
  const auto [x, analysis] = started(problem);
  const Eigen::VectorXd values = values_of(*analysis);
  const Eigen::MatrixXd direct =
      sampled_gradients(*analysis, response_values(*analysis), ExactMethod::direct);
  const Eigen::MatrixXd differences = extrapolated_differences(problem, x);
  for (Eigen::Index i = 0; i < direct.rows(); ++i) {
    EXPECT_LT(gradient_error(direct.row(i), differences.row(i), x, std::abs(values(i))), 2e-7)
        << problem.responses[i].name;
  }
}

TEST(DerivativeCheck, BlamesALooseNewtonToleranceAndNotTheDerivatives) {
  const auto [problem, x, analysis] = AtStart(loose_problem());
  const ProblemFile tight = loose_problem(1e-12);
  const auto tight_analysis = analyze(tight, x);
  const auto checks = check_derivatives(problem, x, *analysis);
  const auto tight_checks = check_derivatives(tight, x, *tight_analysis);
  int loose = 0;
  for (std::size_t i = 0; i < checks.responses.size(); ++i) {
    EXPECT_NE(checks.responses[i].worst().verdict, DerivativeVerdict::differs);
    for (const JudgedDerivative& judged : checks.responses[i].directions) {
      if (!judged.tight_error) continue;
      ++loose;
      EXPECT_EQ(judged.verdict, DerivativeVerdict::noise);
      EXPECT_GT(judged.error, 1e-6);  // what differences with this tolerance say
      EXPECT_LT(*judged.tight_error, judged.error);
    }
    EXPECT_EQ(tight_checks.responses[i].worst().verdict, DerivativeVerdict::agrees);
  }
  EXPECT_GT(loose, 0);
}

/// The analysis of another design: its derivatives are wrong, however loose the tolerance is.
TEST(DerivativeCheck, DoesNotExcuseWrongDerivativesByALooseTolerance) {
  const ProblemFile problem = loose_problem();
  const Eigen::VectorXd x = start_design(problem);
  const auto elsewhere = analyze(problem, 1.01 * x);
  bool any_differs = false;
  for (const DerivativeCheck& check : check_derivatives(problem, x, *elsewhere).responses) {
    any_differs = any_differs || check.worst().verdict == DerivativeVerdict::differs;
    for (const JudgedDerivative& judged : check.directions) {
      EXPECT_FALSE(judged.tight_error.has_value());
    }
  }
  EXPECT_TRUE(any_differs);
}

TEST(DerivativeCheck, NoticesThatAnalysisAndDesignDoNotBelongTogether) {
  const ProblemFile problem = test::quick_problem();
  const Eigen::VectorXd x = start_design(problem);
  const auto elsewhere = analyze(problem, 1.01 * x);
  const auto checks = check_derivatives(problem, x, *elsewhere);
  // Each variable is wrong, so each is alone in the end.
  EXPECT_EQ(checks.directions.size(), problem.variables.size());
  for (const JudgedDerivative& judged : checks.responses.front().directions) {
    // The mass grows with the square of the diameter: its gradient is 1 % off.
    EXPECT_NEAR(judged.error, 0.01, 1e-6);
    EXPECT_EQ(judged.verdict, DerivativeVerdict::differs);
    EXPECT_EQ(judged.curve.size(), 7u);  // no step is spared where something is wrong
  }
}

/// A bar of segments on a slide: the derivative of its mass by a diameter depends on that diameter
/// alone, so the analysis of a design where one is changed has one wrong derivative.
ProblemFile segmented_bar(int segments) {
  std::vector<std::string> parts, variables;
  for (int i = 0; i < segments; ++i) {
    parts.push_back(fmt::format(
        R"({{"elements": 1, "section": {{"type": "circle", "diameter": {{"variable": "d{}"}}}}}})",
        i));
    variables.push_back(
        fmt::format(R"("d{}": {{"start": 0.01, "lower": 0.005, "upper": 0.02}})", i));
  }
  return problem_from(fmt::format(R"({{"scene": {{
          "materials": {{"steel": {{"young": "210 GPa", "poisson": 0.3, "density": 7850}}}},
          "bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0],
            "material": "steel", "segments": [{}]}}}},
          "joints": {{"slide": {{"type": "prismatic", "bodies": ["ground", "bar"], "at": [0, 0, 0],
            "axis": [1, 0, 0]}}}}}},
          "simulation": {{"end_time": 0.01, "step": 0.001}},
          "variables": {{{}}}, "responses": {{"mass": {{"type": "mass"}}}}}})",
                                  fmt::join(parts, ", "), fmt::join(variables, ", ")));
}

TEST(DerivativeCheck, FindsTheOneVariableWhoseDerivativeIsWrongByHalves) {
  constexpr int segments = 16, wrong = 5;
  const ProblemFile problem = segmented_bar(segments);
  const Eigen::VectorXd x = start_design(problem);
  Eigen::VectorXd elsewhere = x;
  elsewhere(wrong) *= 1.001;
  const auto analysis = analyze(problem, elsewhere);
  const auto checks = check_derivatives(problem, x, *analysis);
  const DerivativeCheck& mass = checks.responses.front();
  ASSERT_EQ(checks.directions.size(), 5u);  // 4, 1, 1, 2 and 8 variables
  int found = 0;
  for (std::size_t k = 0; k < checks.directions.size(); ++k) {
    const std::vector<Eigen::Index>& variables = checks.directions[k].variables;
    found += int(variables.size());
    const bool has_it = std::ranges::find(variables, wrong) != variables.end();
    EXPECT_EQ(mass.directions[k].verdict,
              has_it ? DerivativeVerdict::differs : DerivativeVerdict::agrees);
    EXPECT_TRUE(!has_it || variables.size() == 1);
  }
  EXPECT_EQ(found, segments);
}

/// Every response that counts (a relative change along the direction moves it by a hundredth of
/// that), with an error put into one of its derivatives, against the same differences and noise.
TEST(DerivativeCheck, FindsErrorsPutIntoDerivativesOfASimulation) {
  const auto [problem, x, analysis] = AtStart(test::quick_problem());
  const Eigen::MatrixXd gradients =
      sampled_gradients(*analysis, response_values(*analysis), ExactMethod::direct);
  const auto checks = check_derivatives(problem, x, *analysis);
  const ResponseNoise noise = response_noise(problem, x);
  const Eigen::VectorXd values = values_of(*analysis);
  const CheckedDirection& all = checks.directions.front();
  int counted = 0;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const JudgedDerivative& right = checks.responses[i].directions.front();
    const double value = std::abs(values(i));
    for (Eigen::Index j = 0; j < x.size(); ++j) {
      const double part = gradients(i, j) * all.change(j);
      if (std::abs(part) < 0.01 * value) continue;
      ++counted;
      for (const double error : {1e-3, -1e-3, 1e-2, -1e-2}) {
        const JudgedDerivative wrong =
            judge_derivative({right.derivative + error * part, 1.0, value, noise.scatter(i),
                              noise.remainder(i), false},
                             right.curve);
        EXPECT_EQ(wrong.verdict, DerivativeVerdict::differs)
            << problem.responses[i].name << ", " << problem.variables[j].name << ": " << error;
      }
    }
  }
  EXPECT_GT(counted, 8);
}

constexpr double place = 2.0;

/// Central differences of f(x) = x³ at 2, in error by one deviation of the noise of f, to
/// alternating sides: f' = 12, f = 8.
std::vector<CentralDifference> cubic_differences(double noise) {
  std::vector<CentralDifference> curve;
  double side = 1.0;
  for (const double step : {1e-5, 1e-4, 1e-6, 1e-3, 1e-7, 1e-2, 1e-8}) {
    const double delta = step * place;
    const double exact = 3.0 * place * place + delta * delta;  // of a cubic
    curve.push_back({step, exact + side * noise / (std::sqrt(2.0) * delta)});
    side = -side;
  }
  return curve;
}

DerivativeEvidence evidence(double derivative, double noise) {
  return {derivative, place, 8.0, noise, 0.0, false};
}

JudgedDerivative judged(double derivative, double noise) {
  return judge_derivative(evidence(derivative, noise), cubic_differences(noise));
}

TEST(DerivativeVerdict, OfTheRightDerivativeIsThatItAgrees) {
  const JudgedDerivative right = judged(12.0, 1e-13);
  EXPECT_EQ(right.verdict, DerivativeVerdict::agrees);
  // Truncation h² · 4/12 and noise 1e-13 / (√2 · 2 h · 12) are equal near h = 2e-5.
  EXPECT_EQ(right.step, 1e-5);
  EXPECT_LT(right.error, 1e-8);
  // The curve ascends and has the shape of a V.
  ASSERT_EQ(right.curve.size(), 7u);
  for (std::size_t k = 1; k < right.curve.size(); ++k) {
    EXPECT_GT(right.curve[k].step, right.curve[k - 1].step);
    const bool falls = right.curve[k].error < right.curve[k - 1].error;
    EXPECT_EQ(falls, right.curve[k].step <= right.step) << right.curve[k].step;
  }
}

/// At a step of 1e-8 noise is as large as the error; the better steps show it all the same.
TEST(DerivativeVerdict, OfAWrongDerivativeIsNotExcusedByNoiseOfTheSmallestStep) {
  for (const auto& [wrong, noise] :
       std::vector<std::pair<double, double>>{{12.0 * (1.0 + 1e-5), 1e-12},
                                              {12.0 * (1.0 + 1e-4), 1e-12},
                                              {12.0 * (1.0 + 1e-2), 1e-12},
                                              {36.0, 1e-12},
                                              {-12.0, 1e-12},
                                              {0.0, 1e-12},
                                              {18.0, 1e-4}}) {
    EXPECT_EQ(judged(wrong, noise).verdict, DerivativeVerdict::differs) << wrong;
  }
}

/// Noise of 1e-4 leaves 1e-4 / (√2 · 2e-3) = 0.035 of 12 uncertain even at a step of 1e-3.
TEST(DerivativeVerdict, OfARightDerivativeOfANoisyResponseIsNoise) {
  const JudgedDerivative right = judged(12.0, 1e-4);
  EXPECT_GT(right.error, 1e-6);
  EXPECT_EQ(right.verdict, DerivativeVerdict::noise);
  EXPECT_GT(right.resolution, 1e-4 / (std::sqrt(2.0) * 2e-3) / 12.0);
}

/// A response that is nothing but noise, as the drift of constraints that do not drift: its
/// derivative is as small as its value, differences are of the size of noise / step.
TEST(DerivativeVerdict, OfAResponseThatIsNoiseIsNoise) {
  const double noise = 1e-16;
  std::vector<CentralDifference> curve;
  for (const double step : {1e-3, 1e-4, 1e-5, 1e-6}) {
    curve.push_back({step, noise / (step * place)});
  }
  const DerivativeEvidence drift{3e-16, place, 2e-16, noise, 0.0, false};
  EXPECT_EQ(judge_derivative(drift, curve).verdict, DerivativeVerdict::noise);
}

/// What Newton's method leaves is smooth: it makes the derivative of f wrong by as much as f, at
/// every step alike.
TEST(DerivativeVerdict, CountsWhatNewtonsMethodLeavesOnceAtEveryStep) {
  const auto verdict = [](double error, double remainder) {
    DerivativeEvidence loose = evidence(12.0 + error, 1e-13);
    loose.remainder = remainder;
    return judge_derivative(loose, cubic_differences(1e-13)).verdict;
  };
  EXPECT_EQ(verdict(1e-4, 0.0), DerivativeVerdict::differs);
  EXPECT_EQ(verdict(1e-4, 1e-4), DerivativeVerdict::noise);
  EXPECT_EQ(verdict(1e-2, 1e-4), DerivativeVerdict::differs);
}

/// Differences that do not settle, as next to peaks between steps of time: their scatter of 10 %
/// hides a part in ten thousand, but not a wrong term.
TEST(DerivativeVerdict, OfAWrongDerivativeIsNotExcusedByTruncation) {
  std::vector<CentralDifference> curve;
  double side = 1.0;
  for (const double step : {1e-6, 1e-5, 1e-4, 1e-3}) {
    curve.push_back({step, 12.0 * (1.0 + (step == 1e-4 ? 1e-4 : 0.1 * side))});
    side = -side;
  }
  EXPECT_EQ(judge_derivative(evidence(12.0, 1e-13), curve).verdict, DerivativeVerdict::noise);
  EXPECT_EQ(judge_derivative(evidence(12.3, 1e-13), curve).verdict, DerivativeVerdict::differs);
}

TEST(DerivativeVerdict, NextToAKinkIsThatItIsAKink) {
  DerivativeEvidence near_kink = evidence(13.0, 1e-13);
  near_kink.has_kink = true;
  EXPECT_EQ(judge_derivative(near_kink, cubic_differences(1e-13)).verdict, DerivativeVerdict::kink);
  near_kink.derivative = 12.0;  // not near enough to be seen
  EXPECT_EQ(judge_derivative(near_kink, cubic_differences(1e-13)).verdict,
            DerivativeVerdict::agrees);
}

TEST(DerivativeVerdict, DoesNotDependOnTheUnitOfTheVariable) {
  const double millimetres = 1e3;
  std::vector<CentralDifference> curve = cubic_differences(1e-4);
  for (CentralDifference& difference : curve) difference.value /= millimetres;
  DerivativeEvidence scaled = evidence(12.0 / millimetres, 1e-4);
  scaled.size *= millimetres;
  const JudgedDerivative here = judged(12.0, 1e-4), there = judge_derivative(scaled, curve);
  EXPECT_EQ(there.verdict, here.verdict);
  EXPECT_NEAR(there.error / here.error, 1.0, 1e-9);
}

}  // namespace
}  // namespace pleuel::test::derivative_check_test
