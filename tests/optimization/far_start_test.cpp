#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "backend_names.hpp"
#include "core/base/eager_matrices.hpp"
#include "known_problems.hpp"
#include "optimization/backends.hpp"
#include "optimization/solve.hpp"

namespace pleuel::test::far_start_test {
namespace {

/// The same problem, started somewhere between its bounds, or between −4 and 4 where it has none.
FunctionProblem started_anywhere(const KnownProblem& known, std::mt19937& engine) {
  std::vector<Variable> variables = known.problem.variables();
  for (Variable& variable : variables) {
    const double lower = std::isfinite(variable.lower) ? variable.lower : -4.0;
    const double upper = std::isfinite(variable.upper) ? variable.upper : 4.0;
    const double part = static_cast<double>(engine()) / std::mt19937::max();
    variable.start = lower + part * (upper - lower);
  }
  return {variables, known.problem.constraints(),
          [problem = known.problem](const Eigen::VectorXd& x, Request request) mutable {
            return problem.evaluate(x, request);
          }};
}

class FarStart : public testing::TestWithParam<std::string> {};

// Without HS071, which has further local optima, for instance (1, 1.449, 5, 3.449). Of 280 such
// starts for each backend, all but one (ipopt on HS100, reported as stalled) ended verified at the
// optimum. HS100 is so flat in x₅ that residuals below 1e-3 allow 0.5 %.
TEST_P(FarStart, EndsAtTheOptimumOrUnverified) {
  std::mt19937 engine(7);
  int verified = 0, runs = 0;
  for (int sample = 0; sample < 4; ++sample) {
    for (const KnownProblem& known : all_known_problems()) {
      if (known.name == "HS071") continue;
      FunctionProblem problem = started_anywhere(known, engine);
      const Result result = solve(problem, {.backend = GetParam()});
      ++runs;
      if (result.status != Status::verified) continue;
      ++verified;
      EXPECT_NEAR(result.evaluation.objective, known.optimum, 1e-3 * std::abs(known.optimum))
          << known.name;
    }
  }
  EXPECT_GE(verified, runs - 1);
}

// With a wire of 0.245, five times the optimum, the deflection is 1000 times too small: plain MMA
// wanders outside the limits for 200 iterations.
TEST_P(FarStart, OutsideTheLimitsIsLedBackInside) {
  const KnownProblem known = tension_spring();
  std::vector<Variable> variables = known.problem.variables();
  for (Variable& variable : variables) {
    variable.start = 0.9 * variable.lower + 0.1 * variable.upper;
  }
  FunctionProblem problem(
      variables, known.problem.constraints(),
      [inner = known.problem](const Eigen::VectorXd& x, Request request) mutable {
        return inner.evaluate(x, request);
      });
  const Result result = solve(problem, {.backend = GetParam()});
  EXPECT_GT(result.history.front().max_violation, 0.9);
  EXPECT_EQ(result.status, Status::verified) << result.message;
  EXPECT_NEAR(result.evaluation.objective, known.optimum, 1e-3 * known.optimum);
}

INSTANTIATE_TEST_SUITE_P(Backends, FarStart, testing::ValuesIn(optimizer_names()), name_of_backend);

}  // namespace
}  // namespace pleuel::test::far_start_test
