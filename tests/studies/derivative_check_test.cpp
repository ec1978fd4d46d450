#include "studies/derivative_check.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/relative_error.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/sampled_gradients.hpp"
#include "studies/noise.hpp"
#include "tests/studies/quick_problem.hpp"
#include "tests/support/source_folder.hpp"

namespace pleuel::test::derivative_check_test {
namespace {

TEST(DerivativeCheck, AgreesForEveryResponseOfASampleProblem) {
  const ProblemFile problem = test::quick_problem();
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const auto checks = check_derivatives(problem, x, *analysis);
  ASSERT_EQ(checks.size(), problem.responses.size());
  for (std::size_t i = 0; i < checks.size(); ++i) {
    // Differences of simulations with round-off 1e-12 reach 1e-8; what `check` allows is 1e-6.
    EXPECT_LT(checks[i].error, 1e-6) << problem.responses[i].name;
    for (std::size_t j = 0; j < checks[i].variables.size(); ++j) {
      EXPECT_EQ(checks[i].variables[j].verdict, DerivativeVerdict::agrees)
          << problem.responses[i].name << ", " << problem.variables[j].name << ": "
          << checks[i].variables[j].error;
    }
  }
}

TEST(DerivativeCheck, FindsThatDirectAndAdjointAreTheSameUpToRoundOff) {
  const ProblemFile problem = test::quick_problem();
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const auto checks = check_derivatives(problem, x, *analysis);
  for (std::size_t i = 0; i < checks.size(); ++i) {
    EXPECT_LT(checks[i].adjoint_error, 1e-10) << problem.responses[i].name;
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
        R"({0}"j{1}": {{"type": "revolute", "bodies": ["{2}", "b{1}"], "at": [{3}, 0, 0],
            "axis": [0, 0, 1]{4}}})",
        i == 0 ? "" : ", ", i, before, 0.2 * i, drive);
  }
  const ProblemFile problem = read_problem_text(
                                  R"({"scene": {"gravity": [0, -9.81, 0],
          "materials": {"soft": {"young": "2 GPa", "poisson": 0.3, "density": 1200}},
          "bodies": {)" + bodies + R"(}, "joints": {)" +
                                      joints + R"(}},
          "simulation": {"end_time": "0.5 s", "step": "1 ms",
            "formulation": "stabilized-index-2"},
          "variables": {"h": {"start": 0.01, "lower": 0.005, "upper": 0.02},
            "w": {"start": 0.012, "lower": 0.005, "upper": 0.02}},
          "responses": {
            "a": {"type": "acceleration", "body": "b4", "at": 1, "direction": "y",
              "over_time": "max-abs"},
            "s": {"type": "stress", "body": "b0", "over_time": "max"}}})",
                                  "chain.json")
                                  .complete();
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
  const ProblemFile problem = test::quick_problem(
      {"/simulation/newton_tolerance=1e-4", R"(/responses/balance={"type": "energy-balance"})",
       R"(/responses/drift={"type": "constraint-drift", "over_time": "max-abs"})",
       R"(/responses/rate={"type": "constraint-drift", "level": "velocity", "over_time": "max-abs"})"});
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const auto checks = check_derivatives(problem, x, *analysis);
  for (std::size_t i = 0; i < checks.size(); ++i) {
    EXPECT_NE(checks[i].verdict(), DerivativeVerdict::differs)
        << problem.responses[i].name << ": " << checks[i].error;
  }
  EXPECT_EQ(checks.at(checks.size() - 2).verdict(), DerivativeVerdict::noise);  // the drift
}

/// Newton's method stops after the same number of iterations at all designs nearby: what it leaves
/// is smooth in the design, and part of the differences but not of the gradient.
ProblemFile loose_problem() {
  return read_problem(source_folder() + "/problems/four_bar.json",
                      {"/simulation/step=1 ms", "/simulation/end_time=30 ms",
                       "/simulation/newton_tolerance=1e-3"})
      .complete();
}

/// Central differences of two steps, extrapolated to none (Richardson): of fourth order, so that
/// steps can be long and round-off small.
Eigen::MatrixXd extrapolated_differences(const ProblemFile& problem, const Eigen::VectorXd& x) {
  const double step = 1e-3;
  return (4.0 * central_differences(problem, x, 0.5 * step) -
          central_differences(problem, x, step)) /
         3.0;
}

ProblemFile tight_problem() {
  ProblemFile problem = loose_problem();
  problem.simulation.newton_tolerance = 1e-12;
  return problem;
}

/// What the check below relies on. Single central differences come within some 1e-6 only: their
/// truncation, as the square of the step, meets their round-off, as its inverse, near 3e-5. What
/// the tolerance leaves in positions is some 1/h² as much in accelerations, and in stress.
TEST(DerivativeCheck, WouldFindTheDerivativesRightWithATightTolerance) {
  ProblemFile problem = tight_problem();
  problem.simulation.newton_tolerance = 1e-13;
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
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
  const ProblemFile problem = loose_problem(), tight = tight_problem();
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const auto tight_analysis = analyze(tight, x);
  const auto checks = check_derivatives(problem, x, *analysis);
  const auto tight_checks = check_derivatives(tight, x, *tight_analysis);
  int loose = 0;
  for (std::size_t i = 0; i < checks.size(); ++i) {
    EXPECT_NE(checks[i].verdict(), DerivativeVerdict::differs);
    for (std::size_t j = 0; j < checks[i].variables.size(); ++j) {
      const JudgedDerivative& judged = checks[i].variables[j];
      if (!judged.tight_error) continue;
      ++loose;
      EXPECT_EQ(judged.verdict, DerivativeVerdict::noise);
      EXPECT_GT(judged.error, 1e-6);  // what differences with this tolerance say
      const JudgedDerivative& better = tight_checks[i].variables[j];
      EXPECT_EQ(*judged.tight_error, better.error);
      EXPECT_LT(*judged.tight_error, std::max(1e-6, better.resolution));  // of differences
      EXPECT_LT(*judged.tight_error, judged.error);
    }
  }
  EXPECT_GT(loose, 0);
}

/// The analysis of another design: its derivatives are wrong, however loose the tolerance is.
TEST(DerivativeCheck, DoesNotExcuseWrongDerivativesByALooseTolerance) {
  const ProblemFile problem = loose_problem();
  const Eigen::VectorXd x = start_design(problem);
  const auto elsewhere = analyze(problem, 1.01 * x);
  bool any_differs = false;
  for (const DerivativeCheck& check : check_derivatives(problem, x, *elsewhere)) {
    any_differs = any_differs || check.verdict() == DerivativeVerdict::differs;
    for (const JudgedDerivative& judged : check.variables) {
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
  // The mass grows with the square of the diameter: its gradient is 1 % off.
  EXPECT_NEAR(checks.front().error, 0.01, 1e-6);
  for (const JudgedDerivative& judged : checks.front().variables) {
    EXPECT_EQ(judged.verdict, DerivativeVerdict::differs);
    EXPECT_EQ(judged.curve.size(), 7u);  // no step is spared where something is wrong
  }
}

/// Every derivative that counts (a relative change of its variable moves the response by a
/// hundredth of that), with an error put into it, against the same differences and noise.
TEST(DerivativeCheck, FindsErrorsPutIntoDerivativesOfASimulation) {
  const ProblemFile problem = test::quick_problem();
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const auto checks = check_derivatives(problem, x, *analysis);
  const ResponseNoise noise = response_noise(problem, x);
  const Eigen::VectorXd values = values_of(*analysis);
  int counted = 0;
  for (std::size_t i = 0; i < checks.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t j = 0; j < checks[i].variables.size(); ++j) {
      const JudgedDerivative& right = checks[i].variables[j];
      const double size = x(j), value = std::abs(values(row));
      if (std::abs(right.derivative) * size < 0.01 * value) continue;
      ++counted;
      for (const double error : {1e-4, -1e-4, 1e-3, -1e-2}) {
        const JudgedDerivative wrong =
            judge_derivative({right.derivative * (1.0 + error), size, value, noise.scatter(row),
                              noise.remainder(row), false},
                             right.curve);
        EXPECT_EQ(wrong.verdict, DerivativeVerdict::differs)
            << problem.responses[i].name << ", " << problem.variables[j].name << ": " << error;
      }
    }
  }
  EXPECT_GT(counted, 8);
}

}  // namespace
}  // namespace pleuel::test::derivative_check_test
