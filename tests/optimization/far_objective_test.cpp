#include <random>

#include "backend_names.hpp"
#include "complex_step.hpp"
#include "core/base/eager_matrices.hpp"
#include "known_problems.hpp"
#include "optimization/backends.hpp"
#include "optimization/scaling.hpp"
#include "optimization/solve.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::far_objective_test {
namespace {

// Objectives that are many decades larger at the start than at their optimum: what is small beside
// the start says nothing of a design.

template <typename V, typename... Entries>
auto column(const V&, const Entries&... entries) {
  Vector<typename V::Scalar> result(sizeof...(entries));
  Eigen::Index row = 0;
  ((result[row++] = entries), ...);
  return result;
}

/// Damage (100/(b h²))¹⁰ of a section of b by h cm with at most 6 cm² and h ≤ 3 b, from one of 0.6
/// by 1.2 cm, where it is 4e20. Both limits hold the optimum: b = √2, h = 3√2, so that b h² = 18
/// √2.
KnownProblem damage() {
  return {"damage",
          {{{"b", 0.6, 0.4, 6.0}, {"h", 1.2, 1.0, 6.0}},
           {{"area", -infinity, 6.0}, {"slenderness", -infinity, 0.0}},
           by_complex_step([](const auto& x) {
             const auto ratio = 100.0 / (x[0] * x[1] * x[1]);
             const auto fifth = ratio * ratio * ratio * ratio * ratio;
             return column(x, fifth * fifth, x[0] * x[1], x[1] - 3.0 * x[0]);
           })},
          std::pow(100.0 / (18.0 * std::sqrt(2.0)), 10.0)};
}

/// d² + exp(20 (2/d³ − 1)), from d = 0.7, where it is 4e41: least where 2 d = 120 d⁻⁴ e, which
/// bisection solves.
KnownProblem penalty() {
  const auto e = [](double d) { return std::exp(20.0 * (2.0 / (d * d * d) - 1.0)); };
  double low = 0.7, high = 4.0;
  for (int i = 0; i < 100; ++i) {
    const double d = 0.5 * (low + high);
    (2.0 * d < 120.0 * e(d) / (d * d * d * d) ? low : high) = d;
  }
  return {"penalty",
          {{{"d", 0.7, 0.6, 4.0}}, {}, by_complex_step([](const auto& x) {
             using std::exp;
             return column(x, x[0] * x[0] + exp(20.0 * (2.0 / (x[0] * x[0] * x[0]) - 1.0)));
           })},
          low * low + e(low)};
}

/// 2 x² + 3 y² + 10 x z with z fixed: s ∘ ∇f changes by s² f'' a step of s, with s = 0.5 of x and 3,
/// its range, of y, which is at its upper bound. 54 is the larger one; that of the fixed z does not
/// count.
TEST(ObjectiveCurvature, IsTheScaledCurvatureOfFreeVariables) {
  FunctionProblem problem({{"x", 0.5, 0.0, 1.0}, {"y", 4.0, 1.0, 4.0}, {"z", 30.0, 30.0, 30.0}}, {},
                          by_complex_step([](const auto& x) {
                            return column(
                                x, 2.0 * x[0] * x[0] + 3.0 * x[1] * x[1] + 10.0 * x[0] * x[2]);
                          }));
  const Eigen::Vector3d x(0.5, 4.0, 30.0);
  const Evaluation at = problem.evaluate(x, Request::values_and_gradients);
  Evaluation there;
  const double curvature = objective_curvature(problem, x, at, [&](const Eigen::VectorXd& beside) {
    EXPECT_LE(beside[1], 4.0);
    there = problem.evaluate(beside, Request::values_and_gradients);
    return &there;
  });
  EXPECT_NEAR(curvature, 3.0 * 3.0 * 6.0, 1e-9);
}

class FarObjective : public testing::TestWithParam<std::string> {};

TEST_P(FarObjective, IsProvenByWhatItIsAtTheEnd) {
  for (KnownProblem known : {damage(), penalty()}) {
    const Result result = find_optimum(known.problem, {.backend = GetParam()});
    EXPECT_EQ(result.status, Status::verified) << known.name << ": " << result.message;
    EXPECT_NEAR(result.evaluation.objective, known.optimum, 1e-3 * known.optimum) << known.name;
  }
}

/// (x − 1)² + (y − x²)², which vanishes at (1, 1), from where it is 4e5: beside what it is there
/// nothing is small, and still it is proven.
TEST_P(FarObjective, ThatVanishesIsProvenByItsCurvature) {
  FunctionProblem squares({{"x", -25.0, -30.0, 30.0}, {"y", 3.0, -30.0, 30.0}}, {},
                          by_complex_step([](const auto& x) {
                            const auto a = x[0] - 1.0, b = x[1] - x[0] * x[0];
                            return column(x, a * a + b * b);
                          }));
  const Result result = find_optimum(squares, {.backend = GetParam(), .max_iterations = 2000});
  EXPECT_EQ(result.status, Status::verified) << result.message;
  EXPECT_NEAR(result.x[0], 1.0, 0.05);
  EXPECT_NEAR(result.x[1], 1.0, 0.1);
}

/// Two targets that cannot both be met, (x/2 − 1)² + (3/x³ − 1)²: started at its optimum, which
/// bisection of the derivative finds, its slopes say nothing of what is small.
TEST_P(FarObjective, IsProvenFromItsOptimum) {
  double low = 1.0, high = 2.0;
  for (int i = 0; i < 100; ++i) {
    const double x = 0.5 * (low + high), cube = x * x * x;
    (x / 2.0 - 1.0 - 18.0 / (cube * x) * (3.0 / cube - 1.0) < 0.0 ? low : high) = x;
  }
  FunctionProblem targets({{"x", low, 0.5, 6.0}}, {}, by_complex_step([](const auto& x) {
                            const auto a = x[0] / 2.0 - 1.0;
                            const auto b = 3.0 / (x[0] * x[0] * x[0]) - 1.0;
                            return column(x, a * a + b * b);
                          }));
  const Result result = find_optimum(targets, {.backend = GetParam()});
  EXPECT_EQ(result.status, Status::verified) << result.message;
  EXPECT_NEAR(result.x[0], low, 1e-3 * low);
}

INSTANTIATE_TEST_SUITE_P(Backends, FarObjective, testing::ValuesIn(optimizer_names()),
                         name_of_backend);

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
}  // namespace pleuel::test::far_objective_test
