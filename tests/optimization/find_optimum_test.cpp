#include <cctype>
#include <random>
#include <set>
#include <tuple>

#include "core/base/eager_matrices.hpp"
#include "optimization/backends.hpp"
#include "optimization/problem.hpp"
#include "optimization/solve.hpp"
#include "tests/optimization/known_problems.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::find_optimum_test {
namespace {

FunctionProblem started_at(const KnownProblem& known, const Eigen::VectorXd& start) {
  return with_each_variable(
      known.problem, [&, i = 0](Variable& variable) mutable { variable.start = start[i++]; });
}

bool has_equality(const KnownProblem& known) {
  return std::ranges::any_of(known.problem.constraints(), &Constraint::is_equality);
}

bool is_taken_by(const std::string& backend, const KnownProblem& known) {
  return !has_equality(known) || make_optimizer(backend, {})->takes_equalities();
}

class FindOptimum : public testing::TestWithParam<std::string> {
 protected:
  SolveOptions options_{.backend = GetParam()};
};

TEST_P(FindOptimum, GoesTheWayOfItsBackendFromGoodStarts) {
  for (KnownProblem& known : all_known_problems()) {
    if (!is_taken_by(GetParam(), known)) continue;
    const Result alone = solve(known.problem, options_);
    if (alone.status != Status::verified) continue;
    const Result found = find_optimum(known.problem, options_);
    EXPECT_EQ(found.x, alone.x) << known.name;
    EXPECT_EQ(found.evaluations, alone.evaluations) << known.name;
    EXPECT_EQ(found.parts.size(), 1u) << known.name;
  }
}

// Each limit is a power of −6 and 1e12 times exceeded at the start. By hand: a = 10, b = 1 is the
// least sum with a⁶ ≥ 1e6 and (a b)⁶ ≥ 1e6.
TEST_P(FindOptimum, ComesIntoLimitsThatAreExceededAMillionTimes) {
  FunctionProblem problem =
      by_formulas({{"a", 0.1, 0.1, 100.0}, {"b", 0.5, 0.1, 100.0}},
                  {{"one", -infinity, 1.0}, {"two", -infinity, 1.0}}, [](const auto& x) {
                    const auto a = x[0] * x[0] * x[0] / 1e3, b = x[1] * x[1] * x[1];
                    return responses(x[0] + 20.0 * x[1], 1.0 / (a * a), 1.0 / (a * a * b * b));
                  });
  const Result result = verified(find_optimum(problem, options_));
  // a b ≥ 10 and a ≥ 10: a + 20 b has its minimum on a b = 10 at a = √200, b = 10/√200.
  EXPECT_NEAR(result.evaluation.objective, 2.0 * std::sqrt(200.0), 2e-3);
  EXPECT_EQ(result.backend, GetParam());
}

// The least deflection that the bounds allow is 0.125, at full width.
TEST_P(FindOptimum, CallsInfeasibleOnlyWithTheLeastViolation) {
  KnownProblem known = cantilever(0.1);
  const Result result = find_optimum(known.problem, options_);
  EXPECT_EQ(result.status, Status::infeasible) << result.message;
  ASSERT_TRUE(result.least_violation.has_value());
  EXPECT_TRUE(result.least_violation->is_proven);
  EXPECT_NEAR(result.max_violation, 0.25, 1e-4);
  EXPECT_THAT(result.message, HasSubstr("deflection ≤ 0.1 cannot be kept"));
  EXPECT_THAT(result.message, HasSubstr("deflection ≤ 0.125"));
  for (const EvaluationRecord& record : result.history) {
    EXPECT_GE(record.max_violation, result.max_violation - 1e-9);
  }
}

TEST_P(FindOptimum, LeavesAStartThatCannotBeEvaluated) {
  const KnownProblem known = cantilever();
  // Σ aᵢ / 4³ = 1.95; the optimum has 1.
  FunctionProblem problem = started_at(known, Eigen::VectorXd::Constant(5, 4.0));
  FunctionProblem fragile = changed(problem, [&](const Eigen::VectorXd&, Evaluation& evaluation) {
    if (evaluation.constraints[0] > 1.5) {
      throw EvaluationFailure("no equilibrium");
    }
  });
  const Result result = verified(find_optimum(fragile, options_));
  EXPECT_NEAR(result.evaluation.objective, known.optimum, 1e-3 * known.optimum);
  EXPECT_TRUE(result.history.front().has_failed());
  EXPECT_THAT(result.message, HasSubstr("the start cannot be evaluated"));
}

TEST_P(FindOptimum, EndsWithTheReasonWhereNothingCanBeEvaluated) {
  FunctionProblem problem({{"a", 1.0, 0.0, 2.0}}, {},
                          [](const Eigen::VectorXd&, Request) -> Evaluation {
                            throw EvaluationFailure("no equilibrium");
                          });
  const Result result = find_optimum(problem, options_);
  EXPECT_EQ(result.status, Status::failed);
  EXPECT_THAT(result.message, HasSubstr("no equilibrium"));
  EXPECT_LE(result.evaluations, 20);
}

TEST_P(FindOptimum, FindsTheKnownOptimaFromAnywhere) {
  std::mt19937 engine(11);
  for (const KnownProblem& known : all_known_problems()) {
    if (known.name == "HS071") continue;  // has further local optima
    FunctionProblem problem = started_anywhere(known.problem, engine);
    const Result result = find_optimum(problem, options_);
    EXPECT_EQ(result.status, Status::verified) << known.name << ": " << result.message;
    EXPECT_NEAR(result.evaluation.objective, known.optimum, 1e-3 * std::abs(known.optimum))
        << known.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Backends, FindOptimum, testing::ValuesIn(optimizer_names()),
                         name_of_backend);

/// The cantilever, whose first evaluations elsewhere than at the start fail. SLSQP gives up after
/// some ten of them in each of its runs, the first and two restarts.
FunctionProblem failing_for_a_while(int failures) {
  KnownProblem known = cantilever();
  const Eigen::VectorXd start = checked_start(known.problem);
  return {known.problem.variables(), known.problem.constraints(),
          [failures, start, known](const Eigen::VectorXd& x, Request request) mutable {
            if (x != start && failures-- > 0) throw EvaluationFailure("no equilibrium");
            return known.problem.evaluate(x, request);
          }};
}

TEST(FindOptimumByOthers, GoesOnWhereABackendIsLost) {
  FunctionProblem problem = failing_for_a_while(35);
  const Result result =
      verified(find_optimum(problem, {.backend = "nlopt-slsqp", .other_backends = {"nlopt-mma"}}));
  EXPECT_EQ(result.backend, "nlopt-mma");
  ASSERT_EQ(result.parts.size(), 2u);
  EXPECT_EQ(result.parts[0].method, "nlopt-slsqp");
  EXPECT_EQ(result.parts[1].method, "nlopt-mma");
  EXPECT_EQ(result.parts[0].evaluations + result.parts[1].evaluations, result.evaluations);
  EXPECT_THAT(result.message, HasSubstr("found with nlopt-mma after nlopt-slsqp"));
}

/// The designs with gradients of a run that began anew: no restart goes the way of another.
TEST(FindOptimumByOthers, NeverGoesTheSameWayTwice) {
  FunctionProblem problem = failing_for_a_while(1000000);
  const Result result = find_optimum(problem, {.backend = "nlopt-slsqp"});
  std::set<std::vector<double>> seen;
  int repeated = 0;
  for (const EvaluationRecord& record : result.history) {
    if (!record.has_failed()) continue;
    repeated += seen.insert({record.x.begin(), record.x.end()}).second ? 0 : 1;
  }
  EXPECT_GT(seen.size(), 20u);
  // The last steps of a line search may be rounded to the same neighbour of the start.
  EXPECT_LE(repeated, 3);
}

TEST(FindOptimumByOthers, StaysWithTheBackendThatIsAskedFor) {
  FunctionProblem problem = failing_for_a_while(20);
  const Result result = find_optimum(problem, {.backend = "nlopt-mma"});
  for (const SearchPart& part : result.parts) EXPECT_EQ(part.method, "nlopt-mma");
}

TEST(FindOptimumByOthers, LeavesOutThoseThatDoNotKnowEqualities) {
  KnownProblem known = hs071();
  std::set<std::string> methods;
  SolveOptions options{.max_iterations = 80, .max_restarts = 0};
  options.verdict.kkt_residual = 0.0;  // nothing is proven
  options.other_backends = {"nlopt-mma", "ipopt"};
  const Result result = find_optimum(known.problem, options);
  for (const SearchPart& part : result.parts) methods.insert(part.method);
  EXPECT_EQ(methods, (std::set<std::string>{"nlopt-slsqp", "ipopt"}));
}

TEST(Starts, StandOnceInEachPartOfEachRange) {
  const std::vector<Variable> variables = {{"a", 1.0, 0.0, 4.0}, {"b", -2.0, -3.0, 5.0}};
  const auto designs = latin_hypercube(variables, 8, 3);
  for (Eigen::Index i = 0; i < 2; ++i) {
    std::set<int> parts;
    for (const Eigen::VectorXd& x : designs) {
      const double lower = variables[std::size_t(i)].lower, upper = variables[std::size_t(i)].upper;
      parts.insert(static_cast<int>(8.0 * (x[i] - lower) / (upper - lower)));
    }
    EXPECT_EQ(parts.size(), 8u);
  }
  EXPECT_EQ(designs, latin_hypercube(variables, 8, 3));
}

TEST(Starts, WithoutBoundsLieWithinTenTimesTheStart) {
  const auto designs = latin_hypercube({{"a", -2.0, -infinity, 1e20}}, 16, 1);
  const auto [least, most] =
      std::ranges::minmax(designs, {}, [](const Eigen::VectorXd& x) { return x[0]; });
  EXPECT_GE(least[0], -22.0);
  EXPECT_LE(most[0], 18.0);
  EXPECT_GT(most[0] - least[0], 35.0);  // 15 of 16 parts of 40 are between them at least
  EXPECT_THAT(thrown<InputError>([&] {
                latin_hypercube({{"a", 0.0, -infinity, 1.0}}, 4, 1);
              }),
              HasSubstr("/variables/a"));
}

using Case = std::tuple<std::size_t, std::string>;  // which known problem, which backend

/// Every problem with every backend that can take it.
std::vector<Case> possible_cases() {
  std::vector<Case> cases;
  const std::vector<KnownProblem> problems = all_known_problems();
  for (std::size_t i = 0; i < problems.size(); ++i) {
    for (const std::string& backend : optimizer_names()) {
      if (is_taken_by(backend, problems[i])) cases.emplace_back(i, backend);
    }
  }
  return cases;
}

std::string case_name(const testing::TestParamInfo<Case>& info) {
  return letters_of(all_known_problems()[std::get<0>(info.param)].name + std::get<1>(info.param));
}

class KnownOptimum : public testing::TestWithParam<Case> {
 protected:
  KnownProblem known_ = all_known_problems()[std::get<0>(GetParam())];
  SolveOptions options_{.backend = std::get<1>(GetParam())};
};

// The optima are published, see known_problems.hpp. The tolerances are what an engineer asks for:
// 0.1 % of the objective, limits kept to 1e-4; measured are 8e-5 (MMA on the spring, whose optimum
// is flat) and 2e-7. Of the other designs on the way none is verified: convexity is not given in
// general, but in all these problems no second KKT point lies on a path.
TEST_P(KnownOptimum, IsReachedAndVerifiedAndNoOtherDesignOnTheWayIs) {
  const Result result = verified(solve(known_.problem, options_));
  EXPECT_NEAR(result.evaluation.objective, known_.optimum, 1e-3 * std::abs(known_.optimum));
  EXPECT_LE(result.max_violation, 1e-4);
  int wrong_designs = 0;
  for (const EvaluationRecord& record : result.history) {
    const double error = std::abs(record.objective - known_.optimum);
    if (error <= 5e-3 * std::abs(known_.optimum)) continue;
    ++wrong_designs;
    EXPECT_NE(judge_anew(known_.problem, record.x).status, Status::verified)
        << "objective " << record.objective << " at " << record.x.transpose();
  }
  EXPECT_GT(wrong_designs, 0);
  const Result second = solve(known_.problem, options_);
  ASSERT_EQ(result.history.size(), second.history.size());
  for (std::size_t k = 0; k < second.history.size(); ++k) {
    EXPECT_EQ(result.history[k].x, second.history[k].x) << "of the same run twice";
    EXPECT_EQ(result.history[k].objective, second.history[k].objective);
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

// Of the first answer of a backend 28 of 30 cases are. With a loose tolerance the backends stop
// early, and 8 of 30 are: the verdict must not depend on it.
TEST(Verdict, OnTheFirstAnswerOfABackendIsRightAndMostlyGiven) {
  EXPECT_GE(verified_cases({.max_restarts = 0}), 25);
  EXPECT_GE(verified_cases({.tolerance = 1e-2, .max_restarts = 0}), 5);
}

TEST(HS071, AnEqualityIsRefusedByBackendsThatKnowNone) {
  KnownProblem known = hs071();
  for (const std::string backend : {"nlopt-mma", "nlopt-ccsaq"}) {
    EXPECT_THAT(thrown<InputError>([&] { solve(known.problem, {.backend = backend}); }),
                AllOf(HasSubstr(backend), HasSubstr("/constraints/sphere is an equality")))
        << backend << " took an equality";
  }
}

class Noise : public testing::TestWithParam<std::string> {};

// Values with a noise of 1e-8, relative, as those of simulations: left alone, MMA and CCSAQ find no
// step conservative and make 20 of their 40 steps below the tolerance, down to rounding.
TEST_P(Noise, IsNotChased) {
  KnownProblem known = ten_bar_truss();
  FunctionProblem problem =
      changed(known.problem, [&](const Eigen::VectorXd& x, Evaluation& evaluation) {
        const double noise = 1e-8 * std::sin(1e9 * x.sum());
        evaluation.objective *= 1.0 + noise;
        evaluation.constraints *= 1.0 - noise;
      });
  SolveOptions options{.backend = GetParam()};
  const Result result = verified(solve(problem, options));
  EXPECT_NEAR(result.evaluation.objective, known.optimum, 1e-5 * known.optimum);
  const auto is_tiny_step = [&](const EvaluationRecord& record) {
    return record.step > 0.0 && record.step < options.tolerance &&
           record.request == Request::values_and_gradients;
  };
  EXPECT_LE(std::ranges::count_if(result.history, is_tiny_step), 3 * (1 + result.restarts));
}

INSTANTIATE_TEST_SUITE_P(Backends, Noise, testing::Values("nlopt-mma", "nlopt-ccsaq"),
                         name_of_backend);

}  // namespace
}  // namespace pleuel::test::find_optimum_test
