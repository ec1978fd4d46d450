#include <algorithm>
#include <cctype>
#include <cmath>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "backend_names.hpp"
#include "core/base/eager_matrices.hpp"
#include "known_problems.hpp"
#include "optimization/backends.hpp"
#include "optimization/solve.hpp"

namespace pleuel::test::optimum_test {
namespace {

using Case = std::tuple<std::size_t, std::string>;  // which known problem, which backend

bool has_equality(const KnownProblem& known) {
  const auto& constraints = known.problem.constraints();
  return std::any_of(constraints.begin(), constraints.end(),
                     [](const Constraint& constraint) { return constraint.is_equality(); });
}

/// Every problem with every backend that can take it.
std::vector<Case> possible_cases() {
  std::vector<Case> cases;
  const std::vector<KnownProblem> problems = all_known_problems();
  for (std::size_t i = 0; i < problems.size(); ++i) {
    for (const std::string& backend : optimizer_names()) {
      const bool possible = make_optimizer(backend, {})->takes_equalities();
      if (possible || !has_equality(problems[i])) cases.emplace_back(i, backend);
    }
  }
  return cases;
}

std::string case_name(const testing::TestParamInfo<Case>& info) {
  std::string name = all_known_problems()[std::get<0>(info.param)].name + std::get<1>(info.param);
  std::erase_if(name, [](char letter) { return std::isalnum(letter) == 0; });
  return name;
}

class KnownOptimum : public testing::TestWithParam<Case> {
 protected:
  KnownProblem known_ = all_known_problems()[std::get<0>(GetParam())];
  SolveOptions options_{.backend = std::get<1>(GetParam())};
};

// The optima are published, see known_problems.hpp. The tolerances are what an engineer asks for:
// 0.1 % of the objective, limits kept to 1e-4; measured are 8e-5 (MMA on the spring, whose optimum
// is flat) and 2e-7.
TEST_P(KnownOptimum, IsReachedAndVerified) {
  const Result result = solve(known_.problem, options_);
  EXPECT_EQ(result.status, Status::verified) << result.message;
  EXPECT_NEAR(result.evaluation.objective, known_.optimum, 1e-3 * std::abs(known_.optimum));
  EXPECT_LE(result.max_violation, 1e-4);
}

// Convexity is not given in general, but in all these problems no second KKT point lies on a path.
TEST_P(KnownOptimum, NoOtherDesignOnTheWayIsVerified) {
  const Result run = solve(known_.problem, options_);
  const Eigen::VectorXd start = checked_start(known_.problem);
  int wrong_designs = 0;
  for (const EvaluationRecord& record : run.history) {
    const bool is_wrong =
        std::abs(record.objective - known_.optimum) > 5e-3 * std::abs(known_.optimum);
    if (!is_wrong) continue;
    ++wrong_designs;
    EXPECT_NE(judge_anew(known_.problem, start, record.x).status, Status::verified)
        << "objective " << record.objective << " at " << record.x.transpose();
  }
  EXPECT_GT(wrong_designs, 0);
}

TEST_P(KnownOptimum, TheSameRunTwiceHasTheSameHistory) {
  const Result first = solve(known_.problem, options_);
  const Result second = solve(known_.problem, options_);
  ASSERT_EQ(first.history.size(), second.history.size());
  for (std::size_t k = 0; k < first.history.size(); ++k) {
    EXPECT_EQ(first.history[k].x, second.history[k].x);
    EXPECT_EQ(first.history[k].objective, second.history[k].objective);
  }
}

INSTANTIATE_TEST_SUITE_P(Problems, KnownOptimum, testing::ValuesIn(possible_cases()), case_name);

// Measured with NLopt 2.7.1 on the unscaled problems: MMA "succeeds" 5.7 % above the optimum of the
// three-bar truss. Here designs on the active stress limit, by solving it for x2.
TEST(ThreeBarTruss, NoDesignAlongTheActiveLimitButTheOptimumIsVerified) {
  KnownProblem truss = three_bar_truss();
  const double root = std::sqrt(2.0);
  // 2 (√2 a + b) = 2 (√2 a² + 2 a b)  ⇒  b = √2 (a² − a) / (1 − 2 a)
  const auto on_limit = [&](double a) {
    return Eigen::Vector2d(a, root * (a * a - a) / (1.0 - 2.0 * a));
  };
  const Eigen::VectorXd start = checked_start(truss.problem);
  for (const double a : {0.6, 0.7, 0.75, 0.85, 0.9, 0.95}) {
    const Verdict verdict = judge_anew(truss.problem, start, on_limit(a));
    EXPECT_EQ(verdict.status, Status::stalled) << verdict.message << " at x1 = " << a;
    EXPECT_GT(verdict.audit.residual, 0.01);
  }
}

/// How many of all cases end verified with such options; those must be right.
int verified_cases(SolveOptions options) {
  int verified = 0;
  for (const auto& [index, backend] : possible_cases()) {
    KnownProblem known = all_known_problems()[index];
    options.backend = backend;
    const Result result = solve(known.problem, options);
    if (result.status != Status::verified) continue;
    ++verified;
    EXPECT_NEAR(result.evaluation.objective, known.optimum, 1e-3 * std::abs(known.optimum))
        << known.name << " with " << backend;
  }
  return verified;
}

// 28 of 30 are.
TEST(Verdict, OnTheFirstAnswerOfABackendIsRightAndMostlyGiven) {
  const int verified = verified_cases({.max_restarts = 0});
  EXPECT_GE(verified, 25);
}

// With a loose tolerance the backends stop early: the verdict must not depend on it. 8 of 30 are
// verified.
TEST(Verdict, OnTheAnswerOfALooseBackendIsRightWhereItIsGiven) {
  const int verified = verified_cases({.tolerance = 1e-2, .max_restarts = 0});
  EXPECT_GE(verified, 5);
}

TEST(HS071, AnEqualityIsRefusedByBackendsThatKnowNone) {
  KnownProblem known = hs071();
  for (const std::string backend : {"nlopt-mma", "nlopt-ccsaq"}) {
    try {
      solve(known.problem, {.backend = backend});
      ADD_FAILURE() << backend << " took an equality";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(),
                  testing::AllOf(testing::HasSubstr(backend),
                                 testing::HasSubstr("/constraints/sphere is an equality")));
    }
  }
}

class Noise : public testing::TestWithParam<std::string> {};

// Values with a noise of 1e-8, relative, as those of simulations: left alone, MMA and CCSAQ find no
// step conservative and make 20 of their 40 steps below the tolerance, down to rounding.
TEST_P(Noise, IsNotChased) {
  KnownProblem known = ten_bar_truss();
  FunctionProblem problem(known.problem.variables(), known.problem.constraints(),
                          [&](const Eigen::VectorXd& x, Request request) {
                            Evaluation evaluation = known.problem.evaluate(x, request);
                            const double noise = 1e-8 * std::sin(1e9 * x.sum());
                            evaluation.objective *= 1.0 + noise;
                            evaluation.constraints *= 1.0 - noise;
                            return evaluation;
                          });
  SolveOptions options{.backend = GetParam()};
  const Result result = solve(problem, options);
  EXPECT_EQ(result.status, Status::verified) << result.message;
  EXPECT_NEAR(result.evaluation.objective, known.optimum, 1e-5 * known.optimum);
  int tiny_steps = 0;
  for (const EvaluationRecord& record : result.history) {
    const bool is_tiny = record.step > 0.0 && record.step < options.tolerance;
    if (is_tiny && record.request == Request::values_and_gradients) ++tiny_steps;
  }
  EXPECT_LE(tiny_steps, 3 * (1 + result.restarts));
}

INSTANTIATE_TEST_SUITE_P(Backends, Noise, testing::Values("nlopt-mma", "nlopt-ccsaq"),
                         name_of_backend);

}  // namespace
}  // namespace pleuel::test::optimum_test
