#include "optimization/phase_one.hpp"

#include <limits>
#include <random>

#include "core/base/eager_matrices.hpp"
#include "optimization/kkt_audit.hpp"
#include "optimization/linear_choice.hpp"
#include "tests/optimization/known_problems.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::phase_one_test {
namespace {

/// f = −a under a + b ≤ 1, a ≥ 2 and b ≤ 3, in 0 ≤ a, b ≤ 10: the first two contradict each other.
/// With magnitudes 1, 2, 3 the largest relative violation is least where b = 0 and
/// a − 1 = (2 − a) / 2, which is 1/3 at a = 4/3.
FunctionProblem contradictory() {
  return by_formulas(
      {{"a", 5.0, 0.0, 10.0}, {"b", 5.0, 0.0, 10.0}},
      {{"sum", -infinity, 1.0}, {"length", 2.0, infinity}, {"width", -infinity, 3.0}},
      [](const auto& x) { return responses(-x[0], x[0] + x[1], x[0], x[1]); });
}

LeastViolation least_violation_of(Problem& problem) {
  return find_least_violation({&problem, own_constraints(problem)}, problem.constraints(),
                              checked_start(problem), 60);
}

TEST(DampedViolation, HasTheSlopeOfDifferences) {
  for (const double g : {-3.0, -0.1, 0.2, 5.0, 400.0}) {
    const double h = 1e-6 * std::max(1.0, std::abs(g));
    const double difference = (damped_violation(g + h) - damped_violation(g - h)) / (2.0 * h);
    // Central differences of a smooth function of order one: 1e-10 of rounding over h.
    EXPECT_NEAR(damped_violation_slope(g), difference, 1e-8);
  }
}

TEST(PhaseOneProblem, HasTheGradientsOfDifferences) {
  KnownProblem known = hs043();
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(4, 0.4, 1.9);  // no g is 0
  const Evaluation at_x = known.problem.evaluate(x, Request::values_and_gradients);
  PhaseOneProblem elastic(known.problem, {true, false, true}, x, at_x, Eigen::Vector3d(2, 3, 4));
  Eigen::VectorXd xz(5);
  xz << x, 0.7;
  const Evaluation exact = elastic.evaluate(xz, Request::values_and_gradients);
  for (Eigen::Index i = 0; i < xz.size(); ++i) {
    const Eigen::VectorXd step = 1e-6 * Eigen::VectorXd::Unit(5, i);
    const Evaluation above = elastic.evaluate(xz + step, Request::values);
    const Evaluation below = elastic.evaluate(xz - step, Request::values);
    const Eigen::VectorXd slopes = (above.constraints - below.constraints) / 2e-6;
    EXPECT_LT((slopes - exact.constraint_jacobian.col(i)).norm(), 1e-8);
    EXPECT_EQ(exact.objective_gradient(i), i == 4 ? 1.0 : 0.0);
  }
}

// Alone the sum has to be 2, or the length may be 1; the width is in nobody's way. Who reads "one
// change would do" of one limit shall not think that the other was forgotten.
TEST(LeastViolation, IsThatOfTheClosedFormAndNamesTheLimitsInConflict) {
  FunctionProblem problem = contradictory();
  LeastViolation least = least_violation_of(problem);
  EXPECT_TRUE(least.is_proven);
  EXPECT_NEAR(least.violation, 1.0 / 3.0, 1e-5);
  EXPECT_NEAR(least.x[0], 4.0 / 3.0, 1e-5);
  EXPECT_NEAR(least.x[1], 0.0, 1e-5);
  ASSERT_EQ(least.limits.size(), 2u);
  for (const ExceededLimit& limit : least.limits) {
    EXPECT_TRUE(limit.is_in_conflict);
    EXPECT_EQ(limit.is_upper, limit.constraint == 0);
    EXPECT_NEAR(limit.together, 4.0 / 3.0, 1e-4);
    ASSERT_TRUE(limit.alone.has_value());
    EXPECT_NEAR(*limit.alone, limit.constraint == 0 ? 2.0 : 1.0, 1e-3);
  }
  EXPECT_THAT(describe(least, problem),
              AllOf(HasSubstr("sum ≤ 1"), HasSubstr("length ≥ 2"), HasSubstr("33.3 %"),
                    Not(HasSubstr("width")), Not(HasSubstr("no value was found"))));
  for (ExceededLimit& limit : least.limits) {
    if (limit.constraint != 0) limit.alone.reset();
  }
  EXPECT_THAT(describe(least, problem),
              AllOf(HasSubstr("One change would do: sum ≤ 2"),
                    HasSubstr("for length alone no value was found that would do")));
}

// At full width everywhere the deflection is Σ aᵢ / 1000 = 0.125.
TEST(LeastViolation, OfASingleLimitIsWhatIsPossible) {
  KnownProblem known = cantilever(0.1);
  const LeastViolation least = least_violation_of(known.problem);
  EXPECT_TRUE(least.is_proven);
  ASSERT_EQ(least.limits.size(), 1u);
  EXPECT_NEAR(least.limits.front().alone.value(), 0.125, 1e-6);
  EXPECT_THAT(describe(least, known.problem), HasSubstr("deflection ≤ 0.125"));
  // Of a problem that has a design it is none.
  KnownProblem feasible = hs100();
  EXPECT_LE(least_violation_of(feasible.problem).violation, 1e-4);
}

// Stresses of round bars, ∝ d⁻³: 1e9 times too high at the start, a straight line in logarithms.
TEST(Restoration, OfPowersTakesAFewSteps) {
  FunctionProblem problem =
      by_formulas({{"a", 0.01, 0.01, 100.0}, {"b", 0.01, 0.01, 100.0}},
                  {{"one", -infinity, 1.0}, {"two", -infinity, 1.0}}, [](const auto& x) {
                    const auto a = x[0] * x[0] * x[0], b = x[1] * x[1] * x[1];
                    return responses(x[0] + x[1], 1e3 / a, 1e3 / (a * b));
                  });
  int evaluations = 0;
  FunctionProblem counted =
      changed(problem, [&](const Eigen::VectorXd&, Evaluation&) { ++evaluations; });
  EXPECT_TRUE(restore_limits(counted, checked_start(counted)).has_value());
  // ln 10 / 0.01 is 6.9, in steps of 0.7, 1.4, 2, 2, 2; two evaluations each.
  EXPECT_LE(evaluations, 14);
}

TEST(Restoration, KeepsEqualitiesToo) {
  KnownProblem known = hs071();
  const auto restored = restore_limits(known.problem, Eigen::Vector4d(4, 1, 2, 3));
  ASSERT_TRUE(restored.has_value());
  EXPECT_NEAR(restored->squaredNorm(), 40.0, 1e-5);
}

TEST(Restoration, OfAStartThatFailsIsNone) {
  FunctionProblem problem({{"a", 1.0, 0.0, 2.0}}, {{"c", -infinity, 0.0}},
                          [](const Eigen::VectorXd&, Request) -> Evaluation {
                            throw EvaluationFailure("no equilibrium");
                          });
  EXPECT_FALSE(restore_limits(problem, Eigen::VectorXd::Ones(1)).has_value());
}

constexpr double box_weight = 30.0, regularization = 1e-4;  // as the header says

Eigen::MatrixXd random_matrix(std::mt19937& engine, Eigen::Index rows, Eigen::Index columns = 1) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&]() { return uniform(engine); });
}

LinearizedLimits random_limits(std::mt19937& engine, Eigen::Index count, Eigen::Index variables) {
  const Eigen::VectorXd residuals = random_matrix(engine, count);
  return {residuals, random_matrix(engine, count, variables)};
}

// The same minimum by its dual, a least-squares problem of the multipliers μ ≥ 0 of all rows and
// sides of the box: d = −Aᵀ μ / λ with μ = argmin ‖[Aᵀ/√λ; 1] μ − [0; r]‖².
Eigen::VectorXd step_by_dual(const LinearizedLimits& limits, const Eigen::VectorXd& down,
                             const Eigen::VectorXd& up) {
  const Eigen::Index n = down.size(), count = limits.residuals.size() + 2 * n;
  const Eigen::MatrixXd sides = box_weight * Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd a(count, n);
  a << limits.slopes, sides, -sides;
  Eigen::VectorXd r(count);
  r << limits.residuals, -box_weight * up, -box_weight * down;
  Eigen::MatrixXd matrix(n + count, count);
  matrix << a.transpose() / std::sqrt(regularization), Eigen::MatrixXd::Identity(count, count);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(matrix.rows());
  right.tail(count) = r;
  const Eigen::VectorXd step =
      -a.transpose() * nonnegative_least_squares(matrix, right) / regularization;
  return step.cwiseMin(up).cwiseMax(-down);
}

TEST(ViolationStep, IsThatOfTheDualProblem) {
  std::mt19937 engine(1);
  for (int sample = 0; sample < 300; ++sample) {
    const Eigen::Index variables = 1 + sample % 6, count = sample % 17;
    const LinearizedLimits limits = random_limits(engine, count, variables);
    const double size = sample % 3 == 0 ? 10.0 : 0.2;  // the box is of no account, or is
    const Eigen::VectorXd up = Eigen::VectorXd::Constant(variables, size), down = 0.5 * up;
    const Eigen::VectorXd step = violation_step(limits, down, up);
    EXPECT_LE((step - step_by_dual(limits, down, up)).norm(), 1e-8 * (1.0 + step.norm()))
        << "sample " << sample;
  }
}

// As many limits as a design of 200 variables has windows of time, most of them violated and with
// dependent rows: no direction within the box helps at the end.
TEST(ViolationStep, CannotBeImprovedWithManyLimits) {
  std::mt19937 engine(2);
  LinearizedLimits limits = random_limits(engine, 2000, 200);
  limits.slopes.bottomRows(500) = limits.slopes.topRows(500);
  const Eigen::VectorXd size = Eigen::VectorXd::Constant(200, 0.7);
  const Eigen::VectorXd step = violation_step(limits, size, size);
  const double least = limits.sum(step) + regularization * step.squaredNorm();
  EXPECT_LT(least, 0.9 * limits.sum(Eigen::VectorXd::Zero(200)));
  for (int sample = 0; sample < 200; ++sample) {
    const Eigen::VectorXd other = step + 0.1 * random_matrix(engine, 200);
    EXPECT_GE(limits.sum(other) + regularization * other.squaredNorm(), least);
  }
}

TEST(ViolationStep, StaysWhereNothingIsViolated) {
  const LinearizedLimits limits{Eigen::Vector2d(-1.0, -2.0), Eigen::Matrix2d::Identity()};
  const Eigen::Vector2d size(0.5, 0.5);
  EXPECT_EQ(violation_step(limits, size, size), Eigen::Vector2d::Zero());
}

constexpr int variables = 4, sizes = 4, rows = 2;

LinearChoiceModel random_model(unsigned seed) {
  std::mt19937 random(seed);
  LinearChoiceModel model;
  model.objective = random_matrix(random, 1)(0);
  model.constraints = Eigen::VectorXd::Zero(rows);
  model.lower = Eigen::VectorXd::Constant(rows, -0.8);
  model.upper = Eigen::VectorXd::Constant(rows, 0.5);
  model.scales = Eigen::VectorXd::Constant(rows, 2.0);
  model.options.resize(variables);
  for (auto& options : model.options) {
    for (int k = 0; k < sizes; ++k) {
      const double objective = random_matrix(random, 1)(0);
      options.push_back({k, objective, random_matrix(random, rows)});
    }
  }
  return model;
}

/// Every choice of the model that keeps its limits, by brute force: the lowest objective first.
std::vector<PredictedChoice> all_choices(const LinearChoiceModel& model, double allowed) {
  std::vector<PredictedChoice> all;
  for (int code = 0; code < sizes * sizes * sizes * sizes; ++code) {
    PredictedChoice one{{}, model.objective};
    Eigen::VectorXd values = model.constraints;
    for (int i = 0, rest = code; i < variables; ++i, rest /= sizes) {
      const LinearOption& option = model.options[i][rest % sizes];
      one.sizes.push_back(option.size);
      one.objective += option.objective;
      values += option.constraints;
    }
    const Eigen::VectorXd room = allowed * model.scales;
    if ((values.array() <= (model.upper + room).array()).all() &&
        (values.array() >= (model.lower - room).array()).all()) {
      all.push_back(std::move(one));
    }
  }
  std::sort(all.begin(), all.end(),
            [](const auto& one, const auto& other) { return one.objective < other.objective; });
  return all;
}

TEST(LinearChoice, FindsTheBestOfAllAsBruteForceDoes) {
  for (const unsigned seed : {1u, 2u, 3u, 4u, 5u}) {
    for (const double allowed : {0.0, 0.1}) {
      const LinearChoiceModel model = random_model(seed);
      const std::vector<PredictedChoice> expected = all_choices(model, allowed);
      ASSERT_GE(expected.size(), 5u);
      const std::vector<PredictedChoice> found = best_choices(model, 5, allowed);
      ASSERT_EQ(found.size(), 5u);
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].sizes, expected[i].sizes) << seed << " " << i;
        EXPECT_NEAR(found[i].objective, expected[i].objective, 1e-12);
      }
    }
  }
}

TEST(LinearChoice, FindsNothingWhereNoChoiceKeepsTheLimitsOrItsBudgetOfBranchingsEnds) {
  LinearChoiceModel model = random_model(1);
  EXPECT_TRUE(best_choices(model, 3, 1e3, 3).empty());
  model.lower.setConstant(100.0);
  model.upper.setConstant(101.0);
  EXPECT_TRUE(best_choices(model, 3, 0.0).empty());
}

using Indexes = std::vector<std::size_t>;
constexpr double none = std::numeric_limits<double>::infinity();

/// 0 ≤ x, y ≤ 1 with other limits.
Indexes conflict_of(const Eigen::MatrixXd& rows, const Eigen::VectorXd& lower,
                    const Eigen::VectorXd& upper) {
  return linear_conflict({rows, lower, upper}, Eigen::VectorXd::Zero(rows.cols()),
                         Eigen::VectorXd::Ones(rows.cols()));
}

TEST(LinearConflict, NamesThePairThatExcludesEachOther) {
  Eigen::MatrixXd rows(3, 2);
  rows << -1, 1, 1, 1, 1, -1;
  // y − x ≥ 0.5 and x − y ≥ 0, beside a harmless one.
  EXPECT_EQ(conflict_of(rows, Eigen::Vector3d(0.5, -none, 0.0), Eigen::Vector3d(none, 2.0, none)),
            (Indexes{0, 2}));
  EXPECT_EQ(conflict_of(rows, Eigen::Vector3d(0.5, -none, -0.5), Eigen::Vector3d(none, 2.0, none)),
            Indexes{});
}

TEST(LinearConflict, NamesALimitThatTheBoundsExclude) {
  Eigen::MatrixXd rows(1, 2);
  rows << 1, 1;
  const auto one = [](double x) { return Eigen::VectorXd::Constant(1, x).eval(); };
  EXPECT_EQ(conflict_of(rows, one(2.0), one(none)), Indexes{});
  EXPECT_EQ(conflict_of(rows, one(2.0 + 1e-6), one(none)), Indexes{0});
}

/// Limits that some point keeps are none; those of which one excludes all points of the others by a
/// margin are, whatever they are: b of a positive combination of the rows, lowered.
TEST(LinearConflict, IsThatOfRandomLimits) {
  std::mt19937 engine(1);
  for (int sample = 0; sample < 200; ++sample) {
    const Eigen::Index variables = 1 + sample % 5, limits = 2 + sample % 6;
    const Eigen::MatrixXd rows = random_matrix(engine, limits, variables);
    const Eigen::VectorXd inside = 0.5 * (random_matrix(engine, variables).array() + 1.0);
    const Eigen::VectorXd free = Eigen::VectorXd::Constant(limits, none);
    const Eigen::VectorXd upper = rows * inside;
    EXPECT_EQ(conflict_of(rows, -free, upper), Indexes{}) << sample;
    // The last row as the negative of the sum of all others: their sum cannot be above their limits.
    Eigen::MatrixXd closed = rows;
    closed.row(limits - 1) = -rows.topRows(limits - 1).colwise().sum();
    Eigen::VectorXd closed_upper = upper;
    closed_upper(limits - 1) = -upper.head(limits - 1).sum() - 1e-3;
    EXPECT_FALSE(conflict_of(closed, -free, closed_upper).empty()) << sample;
    // Limits that touch leave a point; the round-off with which they do is no conflict.
    for (const double gap : {0.0, 1e-16, 1e-13, 1e-11}) {
      closed_upper(limits - 1) = -upper.head(limits - 1).sum() - gap;
      EXPECT_EQ(conflict_of(closed, -free, closed_upper), Indexes{}) << sample << " " << gap;
    }
  }
}

}  // namespace
}  // namespace pleuel::test::phase_one_test
