#include "core/base/eager_matrices.hpp"
#include "optimization/backends.hpp"
#include "optimization/neighbourhood.hpp"
#include "optimization/scaling.hpp"
#include "optimization/solve.hpp"
#include "optimization/verdict.hpp"
#include "tests/optimization/known_problems.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::stationary_test {
namespace {

// Problems that start at designs which fulfil the conditions of Karush, Kuhn & Tucker and are no
// minima: every gradient-based method likes to stay there.

/// cos(phi) of an arm of length 1: its maximum, with a minimum at a bound or at ±π.
KnownProblem arm(double range) {
  return {"arm",
          by_formulas({{"phi", 0.0, -range, range}}, {},
                      [](const auto& x) {
                        using std::cos;
                        return responses(cos(x[0]));
                      }),
          range > std::numbers::pi ? -1.0 : std::cos(range)};
}

/// 1 + x² + (y² − 1)²: a saddle between two minima.
KnownProblem saddle() {
  return {"saddle",
          by_formulas({{"x", 1.0, -3.0, 3.0}, {"y", 0.0, -3.0, 3.0}}, {},
                      [](const auto& x) {
                        const auto gap = x[1] * x[1] - 1.0;
                        return responses(1.0 + x[0] * x[0] + gap * gap);
                      }),
          1.0};
}

/// 5 + a² + b² − 3 ab + (a⁴ + b⁴)/2: rises along both axes, falls between them. Along a = b = r it
/// is 5 − r² + r⁴, least at r² = 1/2.
KnownProblem rotated_saddle() {
  return {"rotated saddle",
          by_formulas({{"a", 0.0, -2.0, 3.0}, {"b", 0.0, -2.0, 3.0}}, {},
                      [](const auto& x) {
                        const auto a = x[0] * x[0], b = x[1] * x[1];
                        return responses(5.0 + a + b - 3.0 * x[0] * x[1] + 0.5 * (a * a + b * b));
                      }),
          4.75};
}

/// x² + 4 y² outside the unit circle: at (0, 1) it rises along every way off the circle and falls
/// along the circle; least at (±1, 0).
KnownProblem circle(double upper) {
  return {upper < infinity ? "on the circle" : "outside the circle",
          by_formulas({{"x", 0.0, -2.0, 2.0}, {"y", 1.0, -2.0, 2.0}}, {{"circle", 1.0, upper}},
                      [](const auto& x) {
                        const auto a = x[0] * x[0], b = x[1] * x[1];
                        return responses(a + 4.0 * b, a + b);
                      }),
          1.0};
}

/// 2 − x² − y from a bound of x that holds nothing; y is held by its own. Least at (1, 1).
KnownProblem bulge_at_a_bound() {
  return {"bulge at a bound",
          by_formulas({{"x", 0.0, 0.0, 1.0}, {"y", 1.0, 0.0, 1.0}}, {},
                      [](const auto& x) { return responses(2.0 - x[0] * x[0] - x[1]); }),
          0.0};
}

/// 2 + x³: neither maximum nor minimum.
KnownProblem inflection() {
  return {"inflection",
          by_formulas({{"x", 0.0, -1.0, 1.0}}, {},
                      [](const auto& x) { return responses(2.0 + x[0] * x[0] * x[0]); }),
          1.0};
}

std::vector<KnownProblem> stationary_starts() {
  return {arm(1.0),    arm(4.0),         saddle(),           rotated_saddle(),
          circle(1.0), circle(infinity), bulge_at_a_bound(), inflection()};
}

Eigen::MatrixXd matrix_of(int rows, int columns, double (*entry)(double, double)) {
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [=](Eigen::Index i, Eigen::Index j) {
    return entry(static_cast<double>(i), static_cast<double>(j));
  });
}

class StationaryStart : public testing::TestWithParam<std::string> {};

TEST_P(StationaryStart, IsLeftForTheMinimum) {
  for (KnownProblem& known : stationary_starts()) {
    const auto& constraints = known.problem.constraints();
    const bool has_equality = !constraints.empty() && constraints.front().is_equality();
    if (has_equality && !make_optimizer(GetParam(), {})->takes_equalities()) continue;
    const Result result = solve(known.problem, {.backend = GetParam()});
    EXPECT_EQ(result.status, Status::verified) << known.name << ": " << result.message;
    EXPECT_NEAR(result.evaluation.objective, known.optimum, 1e-3) << known.name;
  }
}

TEST(StationaryDesign, ThatIsAPlateauSaysSo) {
  for (const bool is_plateau : {true, false}) {
    FunctionProblem problem = by_formulas({{"x", 0.0, -1.0, 1.0}}, {}, [=](const auto& x) {
      return responses(2.0 + (is_plateau ? 0.0 : 1.0) * x[0] * x[0]);
    });
    const bool says_so =
        verified(solve(problem, {})).message.find("nor does any change") != std::string::npos;
    EXPECT_EQ(says_so, is_plateau);
  }
}

INSTANTIATE_TEST_SUITE_P(Backends, StationaryStart, testing::ValuesIn(optimizer_names()),
                         name_of_backend);

TEST(StationaryDesign, ThatIsNoMinimumIsNotVerified) {
  for (KnownProblem& known : stationary_starts()) {
    Eigen::VectorXd start = checked_start(known.problem);
    Eigen::VectorXd x = start;
    if (known.name == "saddle") x[0] = 0.0;
    const Verdict verdict = judge_anew(known.problem, start, x);
    EXPECT_EQ(verdict.status, Status::stalled) << known.name;
    EXPECT_LE(verdict.audit.residual, 1e-3) << known.name;
    ASSERT_TRUE(verdict.better_neighbour) << known.name << ": " << verdict.message;
    const double here = verdict.design.evaluation.objective;
    const Evaluation there = known.problem.evaluate(*verdict.better_neighbour, Request::values);
    EXPECT_LT(there.objective, here - 1e-4 * here) << known.name;
    EXPECT_THAT(verdict.message, HasSubstr("not at a minimum"));
  }
}

/// Where a backend may not start anew, the answer says what it found.
TEST(StationaryDesign, IsNamedWithItsBetterNeighbour) {
  KnownProblem known = arm(1.0);
  const Result result = solve(known.problem, {.max_escapes = 0});
  EXPECT_EQ(result.status, Status::stalled);
  EXPECT_THAT(result.message, HasSubstr("objective is lower by"));
  EXPECT_THAT(result.message, HasSubstr("at phi = "));
}

/// x⁴: as flat as a minimum can be.
TEST(StationaryDesign, ThatIsAFlatMinimumIsVerified) {
  FunctionProblem problem =
      by_formulas({{"x", 0.0, -1.0, 1.0}, {"y", 0.0, -1.0, 1.0}}, {}, [](const auto& x) {
        const auto a = x[0] * x[0], b = x[1] * x[1];
        return responses(1.0 + a * a + 1e-4 * b);
      });
  const Verdict verdict = judge_anew(problem, checked_start(problem));
  EXPECT_EQ(verdict.status, Status::verified) << verdict.message;
}

/// ½ Σ λᵢ zᵢ² + Σ zᵢ⁴ in twenty rotated variables, one λ negative: six products of forty that
/// differences of all gradients would take.
TEST(StationaryDesign, WithOneWayDownAmongTwentyIsNotVerified) {
  constexpr int n = 20;
  const Eigen::MatrixXd rotation = orthonormal_columns(matrix_of(
      n, n, [](double i, double j) { return std::sin(1.0 + 3.0 * i * i + 7.0 * j + i * j); }));
  std::vector<Variable> variables;
  for (int i = 0; i < n; ++i) variables.push_back({"x" + std::to_string(i), 0.0, -1.0, 1.0});
  FunctionProblem problem = by_formulas(variables, {}, [&](const auto& x) {
    using Scalar = std::decay_t<decltype(x[0])>;
    const Vector<Scalar> z = rotation.transpose().cast<Scalar>() * x;
    Scalar sum = 1.0;
    for (int i = 0; i < n; ++i) {
      const double lambda = i == 0 ? -1.0 : 0.1 * i;
      sum += 0.5 * lambda * z[i] * z[i] + z[i] * z[i] * z[i] * z[i];
    }
    return responses(sum);
  });
  EXPECT_TRUE(judge_anew(problem, checked_start(problem)).better_neighbour);
}

/// At most six gradients and four values for the neighbourhood, six values for the gradients.
TEST(StationaryDesign, IsJudgedAtFewEvaluations) {
  int values = 0, gradients = 0;
  KnownProblem known = hs035();
  FunctionProblem counted(known.problem.variables(), {{"g1", -infinity, 3.0}},
                          [&](const Eigen::VectorXd& x, Request request) {
                            ++(request == Request::values ? values : gradients);
                            return known.problem.evaluate(x, request);
                          });
  // HS035: (4/3, 7/9, 4/9), g1 active: two directions are open.
  const Eigen::VectorXd x = Eigen::Vector3d(4.0, 7.0 / 3.0, 4.0 / 3.0) / 3.0;
  const Verdict verdict = judge_anew(counted, checked_start(counted), x);
  EXPECT_EQ(verdict.status, Status::verified) << verdict.message;
  EXPECT_THAT(verdict.message, HasSubstr("along 2 of the 2 directions"));
  EXPECT_LE(gradients, 2 + 1 + 2);  // start, design, that design in the cache, products
  EXPECT_LE(values, 6 + 4);
}

/// f = 1 + 1000 y − x² with 1 + y − k x² ≥ 1. Beside the origin, y as it is, f falls by x² while
/// the limit is violated by k x², here less than what is restored: its price is 1000 k x². So the
/// origin is the minimum for 1000 k > 1 and none below.
FunctionProblem bought_by_violation(double k, double sign = -1.0) {
  return by_formulas({{"x", 0.0, -1.0, 1.0}, {"y", 0.0, -1.0, 1.0}}, {{"limit", 1.0, infinity}},
                     [=](const auto& x) {
                       const auto square = sign * x[0] * x[0];
                       return responses(1.0 + 1000.0 * x[1] + square, 1.0 + x[1] + k * square);
                     });
}

void expect_maximum(FunctionProblem problem) {
  const Verdict verdict = judge_anew(problem, checked_start(problem));
  EXPECT_EQ(verdict.status, Status::stalled) << verdict.message;
  EXPECT_TRUE(verdict.better_neighbour);
}

TEST(Neighbourhood, CountsAViolationAtItsPrice) {
  for (const double k : {0.002, 0.0015}) {
    FunctionProblem minimum = bought_by_violation(k);
    const Verdict verdict = judge_anew(minimum, checked_start(minimum));
    EXPECT_EQ(verdict.status, Status::verified) << verdict.message;
    EXPECT_NEAR(verdict.audit.constraint_multipliers[0], -1000.0, 1e-6);
  }
  expect_maximum(bought_by_violation(0.0005));
}

/// The other way round: what a neighbour keeps better than the design is credited. f = 1 + 1000 y
/// + x² with 1 + y + k x² ≥ 1, whose room beside the origin is worth 1000 k x².
TEST(Neighbourhood, CreditsRoomAtItsPrice) {
  FunctionProblem minimum = bought_by_violation(0.0005, 1.0);
  EXPECT_EQ(judge_anew(minimum, checked_start(minimum)).status, Status::verified);
  expect_maximum(bought_by_violation(0.002, 1.0));
}

/// Against a dense eigensolver.
TEST(LowestCurvature, IsTheSmallestEigenvalueInTheSubspace) {
  const Eigen::MatrixXd matrix = matrix_of(
      6, 6, [](double i, double j) { return std::cos(1.0 + i + j) + (i == j ? 0.3 * i : 0.0); });
  const Eigen::MatrixXd basis = orthonormal_columns(
      matrix_of(6, 4, [](double i, double j) { return std::sin(1.0 + 2.0 * i * j + i); }));
  const HessianProduct product = [&](const Eigen::VectorXd& d) { return matrix * d; };
  const LowestCurvature found = lowest_curvature(product, basis, 6);
  const Eigen::VectorXd exact = eigenvalues_of_symmetric(basis.transpose() * matrix * basis);
  EXPECT_EQ(found.products, 4);
  EXPECT_NEAR(found.curvature, exact[0], 1e-12);
  EXPECT_NEAR(found.direction.dot(matrix * found.direction), found.curvature, 1e-12);
  EXPECT_NEAR((found.direction - basis * (basis.transpose() * found.direction)).norm(), 0, 1e-12);
}

/// Every direction of a multiple of 1 is an eigenvector: Lanczos' method breaks down at once.
TEST(LowestCurvature, IsFoundWhereAllDirectionsAreAlike) {
  const HessianProduct product = [](const Eigen::VectorXd& d) { return Eigen::VectorXd(-2.0 * d); };
  const LowestCurvature found = lowest_curvature(product, Eigen::MatrixXd::Identity(3, 3), 6);
  EXPECT_EQ(found.products, 3);
  EXPECT_NEAR(found.curvature, -2.0, 1e-14);
}

/// f with the gradient that is asked for, right or wrong.
class TwoVariables {
 public:
  using Value = std::function<double(const Eigen::Vector2d&)>;

  TwoVariables(const Value& value, const Eigen::Vector2d& gradient, const Variable& first)
      : problem_({first, {"b", 2.0, -10.0, 10.0}}, {},
                 [this, value, gradient](const Eigen::VectorXd& x, Request) {
                   if (x != start_) steps_.push_back(x - start_);
                   Evaluation evaluation;
                   evaluation.objective = value(x);
                   evaluation.objective_gradient = gradient;
                   evaluation.constraint_jacobian.resize(0, 2);
                   return evaluation;
                 }),
        start_(checked_start(problem_)) {}

  GradientCheck check() {
    const EvaluatedDesign design{start_, problem_.evaluate(start_, Request::values_and_gradients)};
    EvaluationCache cache(problem_, design, {variable_scales(problem_, start_), {}}, {});
    KktAudit audit;
    audit.gradient_scale =
        scaled_objective_gradient(problem_, design.evaluation, local_scales(problem_, start_))
            .norm();
    return check_gradients(cache, design, audit, Tolerances().gradient);
  }

  /// From the start to the designs that were looked at.
  const std::vector<Eigen::Vector2d>& steps() const { return steps_; }

 private:
  std::vector<Eigen::Vector2d> steps_;
  FunctionProblem problem_;
  Eigen::VectorXd start_;
};

const Variable free_variable{"a", 3.0, -10.0, 10.0};
const Eigen::Vector2d slope(1.0, 2.0);

double plane(const Eigen::Vector2d& x) {
  return slope.dot(x);
}

// Two directions that are opposite to each other do not see it. Half of the error lies along each
// of two generic directions; tolerances.gradient is 5e-3.
TEST(GradientCheck, SeesAnErrorAcrossItsFirstDirection) {
  for (const Variable& first : {free_variable, Variable{"a", 10.0, -10.0, 10.0}}) {
    TwoVariables right(plane, slope, first);
    EXPECT_LE(right.check().error, 1e-10);
    const Eigen::Vector2d direction = right.steps().front();
    const Eigen::Vector2d error = Eigen::Vector2d(-direction.y(), direction.x()).normalized();
    TwoVariables wrong(plane, slope + 0.1 * error, first);
    EXPECT_GE(wrong.check().error, 0.01);
  }
}

// |n · (x − x₀)| + plane at x₀, with the gradient of one side.
TEST(GradientCheck, SeesAKinkWhicheverWayItLies) {
  for (int k = 0; k < 12; ++k) {
    const double angle = 2.0 * std::acos(-1.0) * k / 12.0;
    const Eigen::Vector2d normal(3.0 * std::cos(angle), 2.0 * std::sin(angle)), at(3.0, 2.0);
    TwoVariables kinked(
        [&](const Eigen::Vector2d& x) { return plane(x) + std::abs(normal.dot(x - at)); },
        slope + normal, free_variable);
    EXPECT_GE(kinked.check().error, 0.1) << "normal at " << angle;
  }
}

// As the responses of members that ring: the phase ω t turns by 350 rad where a height doubles.
// With h = 1e-3 the third derivative alone would make an error of 1e-3 · 350³ h² / 3 = 0.014.
TEST(GradientCheck, TellsARingingValueFromAWrongGradient) {
  const auto ringing = [](const Eigen::Vector2d& x) {
    return plane(x) / 3.0 + 1e-3 * std::sin(350.0 * x.x() / 3.0);
  };
  const Eigen::Vector2d right = slope / 3.0 + Eigen::Vector2d(0.35 / 3.0 * std::cos(350.0), 0.0);
  EXPECT_LE(TwoVariables(ringing, right, free_variable).check().error, Tolerances().gradient);
  EXPECT_GE(TwoVariables(ringing, 1.05 * right, free_variable).check().error, 0.01);
}

TEST(GradientCheck, LooksAtSixDesignsWithinTheBounds) {
  for (const double start : {-10.0, 0.0, 10.0}) {
    TwoVariables problem(plane, slope, {"a", start, -10.0, 10.0});
    problem.check();
    EXPECT_EQ(problem.steps().size(), 6u);
    for (const Eigen::Vector2d& step : problem.steps()) {
      EXPECT_LE(std::abs(start + step.x()), 10.0);
      EXPECT_NE(step.x(), 0.0);
    }
  }
}

}  // namespace
}  // namespace pleuel::test::stationary_test
