#include "optimization/find_optimum.hpp"

#include <cmath>
#include <random>
#include <set>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "backend_names.hpp"
#include "complex_step.hpp"
#include "core/base/eager_matrices.hpp"
#include "known_problems.hpp"
#include "optimization/backends.hpp"
#include "optimization/starts.hpp"

namespace pleuel::test::find_optimum_test {
namespace {

using testing::HasSubstr;

FunctionProblem started_at(const KnownProblem& known, const Eigen::VectorXd& start) {
  std::vector<Variable> variables = known.problem.variables();
  for (std::size_t i = 0; i < variables.size(); ++i) {
    variables[i].start = start[i];
  }
  return {variables, known.problem.constraints(),
          [problem = known.problem](const Eigen::VectorXd& x, Request request) mutable {
            return problem.evaluate(x, request);
          }};
}

class FindOptimum : public testing::TestWithParam<std::string> {
 protected:
  SolveOptions options_{.backend = GetParam()};
};

TEST_P(FindOptimum, GoesTheWayOfItsBackendFromGoodStarts) {
  for (KnownProblem& known : all_known_problems()) {
    const auto& limits = known.problem.constraints();
    const bool has_equalities =
        std::any_of(limits.begin(), limits.end(), std::mem_fn(&Constraint::is_equality));
    if (has_equalities && !make_optimizer(GetParam(), {})->takes_equalities()) continue;
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
  FunctionProblem problem({{"a", 0.1, 0.1, 100.0}, {"b", 0.5, 0.1, 100.0}},
                          {{"one", -infinity, 1.0}, {"two", -infinity, 1.0}},
                          by_complex_step([](const auto& x) {
                            using Scalar = std::decay_t<decltype(x[0])>;
                            const Scalar a = x[0] * x[0] * x[0] / 1e3, b = x[1] * x[1] * x[1];
                            Vector<Scalar> result(3);
                            result << x[0] + 20.0 * x[1], 1.0 / (a * a), 1.0 / (a * a * b * b);
                            return result;
                          }));
  const Result result = find_optimum(problem, options_);
  EXPECT_EQ(result.status, Status::verified) << result.message;
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
  FunctionProblem fragile(problem.variables(), problem.constraints(),
                          [&](const Eigen::VectorXd& x, Request request) {
                            Evaluation evaluation = problem.evaluate(x, request);
                            if (evaluation.constraints[0] > 1.5) {
                              throw EvaluationFailure("no equilibrium");
                            }
                            return evaluation;
                          });
  const Result result = find_optimum(fragile, options_);
  EXPECT_EQ(result.status, Status::verified) << result.message;
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
    std::vector<Variable> variables = known.problem.variables();
    Eigen::VectorXd start(variables.size());
    for (std::size_t i = 0; i < variables.size(); ++i) {
      const double lower = std::isfinite(variables[i].lower) ? variables[i].lower : -4.0;
      const double upper = std::isfinite(variables[i].upper) ? variables[i].upper : 4.0;
      const double share = static_cast<double>(engine()) / std::mt19937::max();
      start[i] = std::lerp(lower, upper, share);
    }
    FunctionProblem problem = started_at(known, start);
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
      find_optimum(problem, {.backend = "nlopt-slsqp", .other_backends = {"nlopt-mma"}});
  EXPECT_EQ(result.status, Status::verified) << result.message;
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
  double least = 0.0, most = 0.0;
  for (const Eigen::VectorXd& x : designs) {
    least = std::min(least, x[0]);
    most = std::max(most, x[0]);
  }
  EXPECT_GE(least, -22.0);
  EXPECT_LE(most, 18.0);
  EXPECT_GT(most - least, 35.0);  // 15 of 16 parts of 40 are between them at least
}

TEST(Starts, NameAVariableThatNothingIsKnownOf) {
  try {
    latin_hypercube({{"a", 0.0, -infinity, 1.0}}, 4, 1);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/variables/a"));
  }
}

}  // namespace
}  // namespace pleuel::test::find_optimum_test
