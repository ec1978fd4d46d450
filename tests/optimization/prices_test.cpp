#include "optimization/prices.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "complex_step.hpp"
#include "core/base/eager_matrices.hpp"
#include "known_problems.hpp"
#include "optimization/broken_limits.hpp"

namespace pleuel::test::prices_test {
namespace {

using testing::HasSubstr;

/// Limits that need no function: c between 0 and 1, below 10, above 2.
FunctionProblem limits() {
  return FunctionProblem({{"x", 1.0, 0.0, 5.0}},
                         {{"both", 0.0, 1.0}, {"below", -infinity, 10.0}, {"above", 2.0, infinity}},
                         {});
}

TEST(Prices, AreThoseOfLimitsThatAreReached) {
  const FunctionProblem problem = limits();
  const Eigen::Vector3d scales(1.0, 10.0, 2.0), multipliers(0.5, 0.3, -0.2);
  // Reached to 1e-4, slightly violated, reached exactly.
  EXPECT_EQ(prices_of(problem, Eigen::Vector3d(0.9999, 10.0005, 2.0), multipliers, scales),
            multipliers);
  // A slack of 1 % of the magnitude each.
  EXPECT_EQ(prices_of(problem, Eigen::Vector3d(0.99, 9.9, 2.02), multipliers, scales),
            Eigen::Vector3d::Zero());
  // A slack of a thousandth ends a price.
  EXPECT_EQ(
      prices_of(problem, Eigen::Vector3d(1 - 0.9e-3, 10 - 0.9e-2, 2 + 1.8e-3), multipliers, scales),
      multipliers);
  EXPECT_EQ(
      prices_of(problem, Eigen::Vector3d(1 - 1.1e-3, 10 - 1.1e-2, 2 + 2.2e-3), multipliers, scales),
      Eigen::Vector3d::Zero());
  // The lower side of a limit with two.
  EXPECT_EQ(prices_of(problem, Eigen::Vector3d(1e-4, 9.9, 2.02), Eigen::Vector3d(-0.5, 0.3, -0.2),
                      scales),
            Eigen::Vector3d(-0.5, 0.0, 0.0));
}

TEST(Prices, AreThoseOfOptimaOnly) {
  Result result;
  result.evaluation.objective_gradient = Eigen::VectorXd::Ones(1);
  const auto has_prices_as = [&](Status status, double residual) {
    result.status = status;
    result.kkt_residual = residual;
    return has_prices(result);
  };
  EXPECT_TRUE(has_prices_as(Status::verified, 1e-6));
  EXPECT_TRUE(has_prices_as(Status::unresolved, 1e-6));
  EXPECT_TRUE(has_prices_as(Status::stalled, 0.9e-2));
  EXPECT_FALSE(has_prices_as(Status::stalled, 1.1e-2));
  EXPECT_FALSE(has_prices_as(Status::infeasible, 1e-6));
  EXPECT_FALSE(has_prices_as(Status::failed, 1e-6));
  EXPECT_FALSE(has_prices_as(Status::interrupted, 1e-6));
}

/// f*(d) = f*(1) d^{−1/3}: the price is f/3 to first order in the violation, here 3e-5.
TEST(Prices, OfALimitThatIsSlightlyViolatedAreThoseOfTheLimit) {
  KnownProblem known = cantilever();
  const Eigen::VectorXd roots = Vector<double>{{61.0, 37.0, 19.0, 7.0, 1.0}}.array().sqrt().sqrt();
  const Eigen::VectorXd x = roots * std::cbrt(roots.sum()) * (1.0 - 1e-5);
  const Verdict verdict = judge_anew(known.problem, checked_start(known.problem), x);
  EXPECT_GT(verdict.design.max_violation, 2e-5);
  EXPECT_NEAR(verdict.audit.constraint_multipliers[0], known.optimum / 3.0, 1e-3 * known.optimum);
}

TEST(BrokenLimits, AreNamedTheWorstFirst) {
  const FunctionProblem problem = limits();
  const Eigen::Vector3d scales(1.0, 10.0, 2.0);
  EXPECT_EQ(
      broken_limits(problem, Eigen::Vector3d(1.1, 15.0, 1.5), scales, 1e-4),
      "below = 15 exceeds its upper limit 10, above = 1.5 falls below its lower limit 2, both "
      "= 1.1 exceeds its upper limit 1");
  EXPECT_EQ(broken_limits(problem, Eigen::Vector3d(0.5, 10.0005, 2.5), scales, 1e-4), "");
}

/// x ≤ 1 and 2x ≥ 4: no design keeps both.
TEST(InfeasibleDesign, IsTheLeastViolationThatWasSeen) {
  for (const std::string backend : {"nlopt-slsqp", "nlopt-mma", "ipopt"}) {
    FunctionProblem problem({{"x", 0.2, 0.0, 5.0}}, {{"a", -infinity, 1.0}, {"b", 4.0, infinity}},
                            by_complex_step([](const auto& x) {
                              using Scalar = std::decay_t<decltype(x[0])>;
                              Vector<Scalar> values(3);
                              values << x[0] * x[0], x[0], 2.0 * x[0];
                              return values;
                            }));
    const Result result = solve(problem, {.backend = backend});
    EXPECT_EQ(result.status, Status::infeasible) << backend;
    double least = infinity;
    for (const EvaluationRecord& record : result.history) {
      least = std::min(least, record.max_violation);
    }
    EXPECT_EQ(result.max_violation, least) << backend;
    EXPECT_THAT(result.message, HasSubstr("falls below its lower limit 4")) << backend;
  }
}

}  // namespace
}  // namespace pleuel::test::prices_test
