#include <functional>
#include <random>

#include "core/base/eager_matrices.hpp"
#include "optimization/backends.hpp"
#include "optimization/robust_problem.hpp"
#include "optimization/scaling.hpp"
#include "optimization/solve.hpp"
#include "tests/optimization/known_problems.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::scaled_problem_test {
namespace {

/// f = 100 a b², one constraint of each kind; b is fixed.
class EveryKind : public testing::Test {
 protected:
  FunctionProblem problem_ =
      by_formulas({{"a", 30e-3, 10e-3, 60e-3}, {"b", 2.0, 2.0, 2.0}},
                  {{"upper", -infinity, 0.02},
                   {"lower", 0.05, infinity},
                   {"both", 0.05, 0.1},
                   {"equal", 0.2, 0.2},
                   {"free", -infinity, infinity}},
                  [](const auto& x) {
                    return responses(100.0 * x[0] * x[1] * x[1], x[0], 2.0 * x[0], 3.0 * x[0],
                                     4.0 * x[0], 5.0 * x[0]);
                  });
  Eigen::VectorXd start_ = checked_start(problem_);
  EvaluatedDesign design_{start_, problem_.evaluate(start_, Request::values_and_gradients)};
  Eigen::VectorXd scales_ = variable_scales(problem_, start_);
  EvaluationCache cache_{
      problem_, design_, {scales_, constraint_scales(problem_, design_.evaluation, scales_)}, {}};
  ScaledProblem scaled_{cache_, design_, {100, 100, 10, 30}};
};

TEST_F(EveryKind, OfConstraintBecomesOneSidedRowsOfOrderOne) {
  ASSERT_EQ(scaled_.inequalities(), 4);  // upper, lower, and both sides of the third
  ASSERT_EQ(scaled_.equalities(), 1);
  const auto evaluation = scaled_.evaluate(scaled_.start(), Request::values);
  ASSERT_TRUE(evaluation);
  // a = 0.03: (0.03 − 0.02)/0.02, (0.05 − 0.06)/0.05, (0.09 − 0.1)/0.1, (0.05 − 0.09)/0.1.
  EXPECT_TRUE(evaluation->inequalities.isApprox(Eigen::Vector4d(0.5, -0.2, -0.1, -0.4), 1e-12));
  EXPECT_NEAR(evaluation->equalities[0], (0.12 - 0.2) / 0.2, 1e-12);
  EXPECT_NEAR(evaluation->objective, 1.0, 1e-12);
}

TEST_F(EveryKind, OfGradientIsTheSlopeOfItsRow) {
  const Eigen::VectorXd y = scaled_.start();
  const auto here = scaled_.evaluate(y, Request::values_and_gradients);
  const double step = 1e-6;  // the rows are linear: only rounding, 1e-16 / 1e-6
  const auto there = scaled_.evaluate(y.array() + step, Request::values);
  ASSERT_TRUE(here && there);
  const Eigen::VectorXd inequalities = (there->inequalities - here->inequalities) / step;
  const Eigen::VectorXd equalities = (there->equalities - here->equalities) / step;
  EXPECT_TRUE(here->inequality_jacobian.col(0).isApprox(inequalities, 1e-8));
  EXPECT_TRUE(here->equality_jacobian.col(0).isApprox(equalities, 1e-8));
  EXPECT_NEAR(here->objective_gradient[0], (there->objective - here->objective) / step, 1e-8);
}

TEST_F(EveryKind, OfVariableButTheFixedOnesIsSeenAndStaysExactlyWithinItsBounds) {
  EXPECT_EQ(scaled_.variables(), 1);
  EXPECT_EQ(scaled_.to_design(scaled_.start()), start_);
  for (const double beyond : {1.0, 1.1}) {
    EXPECT_EQ(scaled_.to_design(scaled_.upper() * beyond)[0], 60e-3);
    EXPECT_EQ(scaled_.to_design(scaled_.lower() / beyond)[0], 10e-3);
  }
}

TEST_F(EveryKind, OfQuestionAboutOneDesignCostsOneEvaluation) {
  const Eigen::VectorXd y = scaled_.start() * 1.1;
  scaled_.evaluate(y, Request::values_and_gradients);
  scaled_.evaluate(y, Request::values);
  scaled_.evaluate(y, Request::values_and_gradients);
  EXPECT_EQ(cache_.evaluations(), 2);  // the start is the other one
}

/// A NaN would make NLopt's MMA drop the constraint and report success.
TEST(NumbersThatAreNotFinite, ReachNoBackend) {
  const std::vector<std::function<void(Evaluation&)>> mishaps = {
      [](Evaluation& evaluation) { evaluation.objective = infinity; },
      [](Evaluation& evaluation) { evaluation.constraints[0] = std::nan(""); },
      [](Evaluation& evaluation) { evaluation.objective_gradient[1] = std::nan(""); },
      [](Evaluation& evaluation) { evaluation.constraint_jacobian(0, 2) = -infinity; }};
  for (const auto& mishap : mishaps) {
    KnownProblem known = cantilever();
    const Eigen::VectorXd start = checked_start(known.problem);
    FunctionProblem problem =
        changed(known.problem, [&](const Eigen::VectorXd& x, Evaluation& evaluation) {
          if (x != start) mishap(evaluation);
        });
    const EvaluatedDesign design{start, problem.evaluate(start, Request::values_and_gradients)};
    const Eigen::VectorXd scales = variable_scales(problem, start);
    EvaluationCache cache(problem, design,
                          {scales, constraint_scales(problem, design.evaluation, scales)}, {});
    ScaledProblem scaled(cache, design, {100, 100, 10, 30});
    EXPECT_TRUE(scaled.evaluate(scaled.start(), Request::values_and_gradients));
    EXPECT_FALSE(scaled.evaluate(1.1 * scaled.start(), Request::values_and_gradients));
    EXPECT_EQ(count_failures(cache.history()), 1);
  }
}

/// After failed evaluations SLSQP may do so.
TEST_F(EveryKind, OfDesignThatIsNoNumberEndsTheSearchWithoutAnEvaluation) {
  const int before = cache_.evaluations();
  const Eigen::VectorXd nowhere = scaled_.start() * std::nan("");
  EXPECT_FALSE(scaled_.evaluate(nowhere, Request::values));
  EXPECT_TRUE(scaled_.has_left_numbers());
  EXPECT_TRUE(scaled_.should_stop());
  EXPECT_EQ(cache_.evaluations(), before);
}

TEST(Observer, SeesEveryEvaluationAsItHappens) {
  KnownProblem known = cantilever();
  int calls = 0;
  FunctionProblem problem =
      changed(known.problem, [&](const Eigen::VectorXd&, Evaluation&) { ++calls; });
  int seen = 0;
  const Result result = solve(problem, {}, [&](const EvaluationRecord& record) {
    EXPECT_EQ(record.evaluation, ++seen);
    EXPECT_EQ(record.evaluation, calls);
  });
  EXPECT_EQ(seen, result.evaluations);
  EXPECT_EQ(result.history.back().iteration, result.iterations);
}

TEST(Budget, OfIterationsIsKept) {
  for (const std::string backend : {"nlopt-mma", "nlopt-ccsaq", "nlopt-slsqp", "ipopt"}) {
    KnownProblem known = hs100();
    const Result result = solve(known.problem, {.backend = backend, .max_iterations = 4});
    EXPECT_EQ(result.status, Status::stalled);
    EXPECT_LE(result.iterations, 4 + 3);  // at most three designs are audited after the end
    EXPECT_NE(result.message.find("budget of 4 iterations"), std::string::npos);
  }
}

using Eigen::Vector2d;

/// minimize x + y  subject to  c₀ = x² y + sin y ≤ 3,  c₁ = x − y ≥ −10,  c₂ = y² ≤ 100
FunctionProblem curved_problem() {
  return by_formulas(
      {{"x", 1.5, -10.0, 10.0}, {"y", 0.7, -10.0, 10.0}},
      {{"curved", -infinity, 3.0}, {"linear", -10.0, infinity}, {"certain", -infinity, 100.0}},
      [](const auto& x) {
        using std::sin;
        return responses(x[0] + x[1], x[0] * x[0] * x[1] + sin(x[1]), x[0] - x[1], x[1] * x[1]);
      });
}

constexpr double a = 0.1, b = 0.02;  // deviations of x and y

/// σ of c₀, by hand.
double deviation(double x, double y) {
  return std::hypot(a * 2.0 * x * y, b * (x * x + std::cos(y)));
}

class Robust : public testing::Test {
 protected:
  FunctionProblem problem_ = curved_problem();
  RobustProblem robust_{problem_, Vector2d(a, b), Eigen::Vector3d(2.0, 3.0, 0.0)};
  const double x_ = 1.5, y_ = 0.7, sigma_ = deviation(x_, y_);
  const Vector2d design_{x_, y_};
};

TEST_F(Robust, ProblemLimitsTheValueWithItsDeviations) {
  const Evaluation plain = problem_.evaluate(design_, Request::values);
  const Evaluation found = robust_.evaluate(design_, Request::values);
  EXPECT_FALSE(found.has_gradients());
  EXPECT_EQ(found.objective, plain.objective);
  EXPECT_NEAR(found.constraints(0), plain.constraints(0) + 2.0 * sigma_, 1e-14);
  EXPECT_NEAR(found.constraints(1), plain.constraints(1) - 3.0 * std::hypot(a, b), 1e-14);
  EXPECT_EQ(found.constraints(2), plain.constraints(2));
}

/// ∂σ/∂x and ∂σ/∂y by hand: differences of second order err by some 1e-8 h², h = 1e-4.
TEST_F(Robust, ProblemHasTheGradientOfTheDeviation) {
  const double of_x = 2.0 * x_ * y_, of_y = x_ * x_ + std::cos(y_);
  const Vector2d expected((a * a * of_x * 2.0 * y_ + b * b * of_y * 2.0 * x_) / sigma_,
                          (a * a * of_x * 2.0 * x_ - b * b * of_y * std::sin(y_)) / sigma_);
  const auto slopes = [&](Problem& problem) {
    return problem.evaluate(design_, Request::values_and_gradients).constraint_jacobian;
  };
  const Eigen::MatrixXd plain = slopes(problem_), found = slopes(robust_);
  EXPECT_NEAR(found(0, 0), plain(0, 0) + 2.0 * expected(0), 1e-9);
  EXPECT_NEAR(found(0, 1), plain(0, 1) + 2.0 * expected(1), 1e-9);
  EXPECT_NEAR((found.row(1) - plain.row(1)).norm(), 0.0, 1e-12);  // of a constant σ
  EXPECT_EQ(found.row(2), plain.row(2));
}

/// A variable at 0 whose whole range is a micrometre: c = sin(10⁶ x + 1) + 10⁶ y, σ = a 10⁶ |cos|.
TEST(RobustProblem, HasTheGradientOfTheDeviationOfASmallVariableAtZero) {
  const double large = 1e6, small = 1e-8;
  FunctionProblem problem =
      by_formulas({{"x", 0.0, -5e-7, 5e-7}, {"y", 0.0, -5e-7, 5e-7}}, {{"limit", -infinity, 3.0}},
                  [&](const auto& x) {
                    using std::sin;
                    return responses(0.0, sin(large * x[0] + 1.0) + large * x[1]);
                  });
  RobustProblem robust(problem, Vector2d(small, 0.0), Eigen::VectorXd::Constant(1, 2.0));
  const Evaluation found = robust.evaluate(Vector2d(0.0, 0.0), Request::values_and_gradients);
  const double expected = large * std::cos(1.0) - 2.0 * small * large * large * std::sin(1.0);
  EXPECT_NEAR(found.constraint_jacobian(0, 0), expected, 1e-6 * std::abs(expected));
}

class OfEachBackend : public testing::TestWithParam<std::string> {};

/// minimize x  subject to  1/x ≤ 1 with two deviations of x: 1/x + 2 s/x² = 1.
TEST_P(OfEachBackend, RobustOptimumKeepsTheMargin) {
  FunctionProblem problem = by_formulas({{"x", 3.0, 0.1, 10.0}}, {{"limit", -infinity, 1.0}},
                                        [](const auto& x) { return responses(x[0], 1.0 / x[0]); });
  const double s = 0.05;
  RobustProblem robust(problem, Eigen::VectorXd::Constant(1, s), Eigen::VectorXd::Constant(1, 2.0));
  const Result result = verified(solve(robust, SolveOptions{.backend = GetParam()}));
  EXPECT_NEAR(result.x(0), 0.5 * (1.0 + std::sqrt(1.0 + 8.0 * s)), 1e-6);
}

// Objectives that are many decades larger at the start than at their optimum: what is small beside
// the start says nothing of a design.

/// Damage (100/(b h²))¹⁰ of a section of b by h cm with at most 6 cm² and h ≤ 3 b, from one of 0.6
/// by 1.2 cm, where it is 4e20. Both limits hold the optimum: b = √2, h = 3√2, so that b h² = 18
/// √2.
KnownProblem damage() {
  const auto formulas = [](const auto& x) {
    const auto ratio = 100.0 / (x[0] * x[1] * x[1]);
    const auto fifth = ratio * ratio * ratio * ratio * ratio;
    return responses(fifth * fifth, x[0] * x[1], x[1] - 3.0 * x[0]);
  };
  return {"damage",
          by_formulas({{"b", 0.6, 0.4, 6.0}, {"h", 1.2, 1.0, 6.0}},
                      {{"area", -infinity, 6.0}, {"slenderness", -infinity, 0.0}}, formulas),
          std::pow(100.0 / (18.0 * std::sqrt(2.0)), 10.0)};
}

/// Where a rising function vanishes, by bisection.
double root_of(const std::function<double(double)>& function, double low, double high) {
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (function(middle) < 0.0 ? low : high) = middle;
  }
  return low;
}

/// d² + exp(20 (2/d³ − 1)), from d = 0.7, where it is 4e41: least where 2 d = 120 d⁻⁴ e, which
/// bisection solves.
KnownProblem penalty() {
  const auto e = [](const auto& d) {
    using std::exp;
    return exp(20.0 * (2.0 / (d * d * d) - 1.0));
  };
  const double least =
      root_of([&](double d) { return 2.0 * d - 120.0 * e(d) / (d * d * d * d); }, 0.7, 4.0);
  return {"penalty",
          by_formulas({{"d", 0.7, 0.6, 4.0}}, {},
                      [e](const auto& x) { return responses(x[0] * x[0] + e(x[0])); }),
          least * least + e(least)};
}

/// 2 x² + 3 y² + 10 x z with z fixed: s ∘ ∇f changes by s² f'' a step of s, with s = 0.5 of x and 3,
/// its range, of y, which is at its upper bound. 54 is the larger one; that of the fixed z does not
/// count.
TEST(ObjectiveCurvature, IsTheScaledCurvatureOfFreeVariables) {
  FunctionProblem problem = by_formulas(
      {{"x", 0.5, 0.0, 1.0}, {"y", 4.0, 1.0, 4.0}, {"z", 30.0, 30.0, 30.0}}, {}, [](const auto& x) {
        return responses(2.0 * x[0] * x[0] + 3.0 * x[1] * x[1] + 10.0 * x[0] * x[2]);
      });
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

TEST_P(OfEachBackend, FarObjectiveIsProvenByWhatItIsAtTheEnd) {
  for (KnownProblem known : {damage(), penalty()}) {
    const Result result = find_optimum(known.problem, {.backend = GetParam()});
    EXPECT_EQ(result.status, Status::verified) << known.name << ": " << result.message;
    EXPECT_NEAR(result.evaluation.objective, known.optimum, 1e-3 * known.optimum) << known.name;
  }
}

/// (x − 1)² + (y − x²)², which vanishes at (1, 1), from where it is 4e5: beside what it is there
/// nothing is small, and still it is proven.
TEST_P(OfEachBackend, FarObjectiveThatVanishesIsProvenByItsCurvature) {
  FunctionProblem squares =
      by_formulas({{"x", -25.0, -30.0, 30.0}, {"y", 3.0, -30.0, 30.0}}, {}, [](const auto& x) {
        const auto a = x[0] - 1.0, b = x[1] - x[0] * x[0];
        return responses(a * a + b * b);
      });
  const Result result =
      verified(find_optimum(squares, {.backend = GetParam(), .max_iterations = 2000}));
  EXPECT_NEAR(result.x[0], 1.0, 0.05);
  EXPECT_NEAR(result.x[1], 1.0, 0.1);
}

/// Two targets that cannot both be met, (x/2 − 1)² + (3/x³ − 1)²: started at its optimum, which
/// bisection of the derivative finds, its slopes say nothing of what is small.
TEST_P(OfEachBackend, ObjectiveIsProvenFromItsOptimum) {
  const double best = root_of(
      [](double x) {
        const double cube = x * x * x;
        return x / 2.0 - 1.0 - 18.0 / (cube * x) * (3.0 / cube - 1.0);
      },
      1.0, 2.0);
  FunctionProblem targets = by_formulas({{"x", best, 0.5, 6.0}}, {}, [](const auto& x) {
    const auto a = x[0] / 2.0 - 1.0, b = 3.0 / (x[0] * x[0] * x[0]) - 1.0;
    return responses(a * a + b * b);
  });
  const Result result = verified(find_optimum(targets, {.backend = GetParam()}));
  EXPECT_NEAR(result.x[0], best, 1e-3 * best);
}

// Without HS071, which has further local optima, for instance (1, 1.449, 5, 3.449). Of 280 such
// starts for each backend, all but one (ipopt on HS100, reported as stalled) ended verified at the
// optimum. HS100 is so flat in x₅ that residuals below 1e-3 allow 0.5 %.
TEST_P(OfEachBackend, FarStartEndsAtTheOptimumOrUnverified) {
  std::mt19937 engine(7);
  int verified = 0, runs = 0;
  for (int sample = 0; sample < 4; ++sample) {
    for (const KnownProblem& known : all_known_problems()) {
      if (known.name == "HS071") continue;
      FunctionProblem problem = started_anywhere(known.problem, engine);
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
TEST_P(OfEachBackend, FarStartOutsideTheLimitsIsLedBackInside) {
  const KnownProblem known = tension_spring();
  FunctionProblem problem = with_each_variable(known.problem, [](Variable& variable) {
    variable.start = 0.9 * variable.lower + 0.1 * variable.upper;
  });
  const Result result = verified(solve(problem, {.backend = GetParam()}));
  EXPECT_GT(result.history.front().max_violation, 0.9);
  EXPECT_NEAR(result.evaluation.objective, known.optimum, 1e-3 * known.optimum);
}

INSTANTIATE_TEST_SUITE_P(Backends, OfEachBackend, testing::ValuesIn(optimizer_names()),
                         name_of_backend);

}  // namespace
}  // namespace pleuel::test::scaled_problem_test
