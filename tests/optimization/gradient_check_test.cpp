#include "optimization/gradient_check.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "optimization/scaling.hpp"
#include "optimization/verdict.hpp"

namespace pleuel::test::gradient_check_test {
namespace {

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
}  // namespace pleuel::test::gradient_check_test
