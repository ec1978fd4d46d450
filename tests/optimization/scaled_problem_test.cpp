#include <functional>

#include "complex_step.hpp"
#include "core/base/eager_matrices.hpp"
#include "known_problems.hpp"
#include "optimization/backends.hpp"
#include "optimization/robust_problem.hpp"
#include "optimization/scaling.hpp"
#include "optimization/solve.hpp"
#include "tests/optimization/backend_names.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::scaled_problem_test {
namespace {

/// f = 100 a b², one constraint of each kind; b is fixed.
class EveryKind : public testing::Test {
 protected:
  template <typename V>
  static auto responses(const V& x) {
    Vector<typename V::Scalar> result(6);
    result << 100.0 * x[0] * x[1] * x[1], x[0], 2.0 * x[0], 3.0 * x[0], 4.0 * x[0], 5.0 * x[0];
    return result;
  }

  FunctionProblem problem_{{{"a", 30e-3, 10e-3, 60e-3}, {"b", 2.0, 2.0, 2.0}},
                           {{"upper", -infinity, 0.02},
                            {"lower", 0.05, infinity},
                            {"both", 0.05, 0.1},
                            {"equal", 0.2, 0.2},
                            {"free", -infinity, infinity}},
                           by_complex_step([](const auto& x) { return responses(x); })};
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
  const auto slope = [&](const Eigen::VectorXd& from, const Eigen::VectorXd& to) {
    return Eigen::VectorXd((to - from) / step);
  };
  EXPECT_TRUE(here->inequality_jacobian.col(0).isApprox(
      slope(here->inequalities, there->inequalities), 1e-8));
  EXPECT_TRUE(
      here->equality_jacobian.col(0).isApprox(slope(here->equalities, there->equalities), 1e-8));
  EXPECT_NEAR(here->objective_gradient[0], (there->objective - here->objective) / step, 1e-8);
}

TEST_F(EveryKind, OfVariableButTheFixedOnesIsSeen) {
  EXPECT_EQ(scaled_.variables(), 1);
  EXPECT_EQ(scaled_.to_design(scaled_.start()), start_);
}

TEST_F(EveryKind, OfDesignStaysExactlyWithinItsBounds) {
  EXPECT_EQ(scaled_.to_design(scaled_.upper())[0], 60e-3);
  EXPECT_EQ(scaled_.to_design(scaled_.lower())[0], 10e-3);
  EXPECT_EQ(scaled_.to_design(scaled_.upper() * 1.1)[0], 60e-3);
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
    FunctionProblem problem(known.problem.variables(), known.problem.constraints(),
                            [&](const Eigen::VectorXd& x, Request request) {
                              Evaluation evaluation = known.problem.evaluate(x, request);
                              if (x != start) mishap(evaluation);
                              return evaluation;
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
  FunctionProblem problem(known.problem.variables(), known.problem.constraints(),
                          [&](const Eigen::VectorXd& x, Request request) {
                            ++calls;
                            return known.problem.evaluate(x, request);
                          });
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
  return FunctionProblem(
      {{"x", 1.5, -10.0, 10.0}, {"y", 0.7, -10.0, 10.0}},
      {{"curved", -infinity, 3.0}, {"linear", -10.0, infinity}, {"certain", -infinity, 100.0}},
      [](const Eigen::VectorXd& x, Request) {
        Evaluation evaluation;
        evaluation.objective = x.sum();
        evaluation.objective_gradient = Vector2d(1.0, 1.0);
        evaluation.constraints =
            Eigen::Vector3d(x(0) * x(0) * x(1) + std::sin(x(1)), x(0) - x(1), x(1) * x(1));
        evaluation.constraint_jacobian.resize(3, 2);
        evaluation.constraint_jacobian << 2.0 * x(0) * x(1), x(0) * x(0) + std::cos(x(1)), 1.0,
            -1.0, 0.0, 2.0 * x(1);
        return evaluation;
      });
}

constexpr double a = 0.1, b = 0.02;  // deviations of x and y

/// σ of c₀, by hand.
double deviation(double x, double y) {
  return std::hypot(a * 2.0 * x * y, b * (x * x + std::cos(y)));
}

TEST(RobustProblem, LimitsTheValueWithItsDeviations) {
  FunctionProblem problem = curved_problem();
  RobustProblem robust(problem, Vector2d(a, b), Eigen::Vector3d(2.0, 3.0, 0.0));
  const Vector2d x(1.5, 0.7);
  const Evaluation plain = problem.evaluate(x, Request::values);
  const Evaluation found = robust.evaluate(x, Request::values);
  EXPECT_FALSE(found.has_gradients());
  EXPECT_EQ(found.objective, plain.objective);
  EXPECT_NEAR(found.constraints(0), plain.constraints(0) + 2.0 * deviation(1.5, 0.7), 1e-14);
  EXPECT_NEAR(found.constraints(1), plain.constraints(1) - 3.0 * std::hypot(a, b), 1e-14);
  EXPECT_EQ(found.constraints(2), plain.constraints(2));
}

/// ∂σ/∂x and ∂σ/∂y by hand: differences of second order err by some 1e-8 h², h = 1e-4.
TEST(RobustProblem, HasTheGradientOfTheDeviation) {
  FunctionProblem problem = curved_problem();
  RobustProblem robust(problem, Vector2d(a, b), Eigen::Vector3d(2.0, 3.0, 0.0));
  const double x = 1.5, y = 0.7, sigma = deviation(x, y);
  const double of_x = 2.0 * x * y, of_y = x * x + std::cos(y);
  const Vector2d expected((a * a * of_x * 2.0 * y + b * b * of_y * 2.0 * x) / sigma,
                          (a * a * of_x * 2.0 * x - b * b * of_y * std::sin(y)) / sigma);
  const Eigen::MatrixXd plain =
      problem.evaluate(Vector2d(x, y), Request::values_and_gradients).constraint_jacobian;
  const Eigen::MatrixXd found =
      robust.evaluate(Vector2d(x, y), Request::values_and_gradients).constraint_jacobian;
  EXPECT_NEAR(found(0, 0), plain(0, 0) + 2.0 * expected(0), 1e-9);
  EXPECT_NEAR(found(0, 1), plain(0, 1) + 2.0 * expected(1), 1e-9);
  EXPECT_NEAR((found.row(1) - plain.row(1)).norm(), 0.0, 1e-12);  // of a constant σ
  EXPECT_EQ(found.row(2), plain.row(2));
}

/// A variable at 0 whose whole range is a micrometre: c = sin(10⁶ x + 1) + 10⁶ y, σ = a 10⁶ |cos|.
TEST(RobustProblem, HasTheGradientOfTheDeviationOfASmallVariableAtZero) {
  const double large = 1e6, small = 1e-8;
  FunctionProblem problem({{"x", 0.0, -5e-7, 5e-7}, {"y", 0.0, -5e-7, 5e-7}},
                          {{"limit", -infinity, 3.0}}, [&](const Eigen::VectorXd& x, Request) {
                            Evaluation evaluation;
                            evaluation.objective_gradient = Vector2d(0.0, 0.0);
                            evaluation.constraints = Eigen::VectorXd::Constant(
                                1, std::sin(large * x(0) + 1.0) + large * x(1));
                            evaluation.constraint_jacobian.resize(1, 2);
                            evaluation.constraint_jacobian << large * std::cos(large * x(0) + 1.0),
                                large;
                            return evaluation;
                          });
  RobustProblem robust(problem, Vector2d(small, 0.0), Eigen::VectorXd::Constant(1, 2.0));
  const Evaluation found = robust.evaluate(Vector2d(0.0, 0.0), Request::values_and_gradients);
  const double expected = large * std::cos(1.0) - 2.0 * small * large * large * std::sin(1.0);
  EXPECT_NEAR(found.constraint_jacobian(0, 0), expected, 1e-6 * std::abs(expected));
}

class RobustOptimum : public testing::TestWithParam<std::string> {};

/// minimize x  subject to  1/x ≤ 1 with two deviations of x: 1/x + 2 s/x² = 1.
TEST_P(RobustOptimum, KeepsTheMargin) {
  FunctionProblem problem({{"x", 3.0, 0.1, 10.0}}, {{"limit", -infinity, 1.0}},
                          [](const Eigen::VectorXd& x, Request) {
                            Evaluation evaluation;
                            evaluation.objective = x(0);
                            evaluation.objective_gradient = Eigen::VectorXd::Ones(1);
                            evaluation.constraints = x.cwiseInverse();
                            evaluation.constraint_jacobian = -x.cwiseAbs2().cwiseInverse();
                            return evaluation;
                          });
  const double s = 0.05;
  RobustProblem robust(problem, Eigen::VectorXd::Constant(1, s), Eigen::VectorXd::Constant(1, 2.0));
  const Result result = solve(robust, SolveOptions{.backend = GetParam()});
  EXPECT_EQ(result.status, Status::verified) << result.message;
  EXPECT_NEAR(result.x(0), 0.5 * (1.0 + std::sqrt(1.0 + 8.0 * s)), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Backends, RobustOptimum, testing::ValuesIn(optimizer_names()),
                         name_of_backend);

}  // namespace
}  // namespace pleuel::test::scaled_problem_test
