#include "studies/pareto_point.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/scene/case_goals.hpp"
#include "optimization/verdict.hpp"

namespace pleuel {

namespace {

constexpr double least_part = 1e-4;  ///< of the range of a goal: a gain
constexpr double near_zero = 1e-6;   ///< of the accuracy: values below are round-off of 0

GoalScale scale_of(const std::vector<Goals>& front, std::size_t goal) {
  GoalScale scale;
  if (front.empty()) return scale;
  const auto [low, high] = std::ranges::minmax_element(
      front, [&](const Goals& one, const Goals& other) { return one[goal] < other[goal]; });
  scale.low = (*low)[goal];
  scale.high = (*high)[goal];
  scale.accuracy = optimum_accuracy * std::max(std::abs(scale.low), std::abs(scale.high));
  return scale;
}

}  // namespace

double GoalScale::least_gain() const {
  return std::max(least_part * range(), accuracy);
}

double GoalScale::round_off(double one, double other) const {
  return std::max(equal_numbers * std::max(std::abs(one), std::abs(other)), near_zero * accuracy);
}

FrontScale::FrontScale(const std::vector<Goals>& designs) {
  const std::vector<bool> counts = non_dominated(designs);
  std::vector<Goals> front;
  for (std::size_t i = 0; i < designs.size(); ++i) {
    if (counts[i]) front.push_back(designs[i]);
  }
  goals_ = {scale_of(front, 0), scale_of(front, 1)};
}

bool FrontScale::dominates(const Goals& one, const Goals& other, Limits limits) const {
  bool is_better = false;
  for (std::size_t i = 0; i < 2; ++i) {
    const double gain = other[i] - one[i];
    const bool is_kept_alike = i == 1 && limits == Limits::same;
    const double allowed =
        is_kept_alike ? goals_[i].least_gain() : goals_[i].round_off(one[i], other[i]);
    if (gain < -allowed) return false;
    is_better = is_better || gain > goals_[i].least_gain();
  }
  return is_better;
}

bool is_no_better(double one, double other) {
  return one >= other - equal_numbers * std::max(std::abs(one), std::abs(other));
}

std::vector<bool> non_dominated(const std::vector<Goals>& goals) {
  std::vector<bool> marks;
  for (const Goals& one : goals) {
    marks.push_back(std::ranges::none_of(goals, [&](const Goals& other) {
      const bool is_nowhere_worse =
          is_no_better(one[0], other[0]) && is_no_better(one[1], other[1]);
      const bool is_somewhere_better =
          !is_no_better(other[0], one[0]) || !is_no_better(other[1], one[1]);
      return is_nowhere_worse && is_somewhere_better;
    }));
  }
  return marks;
}

Goals goals_of(const ParetoPoint& point, GoodSide side) {
  const double sign = side == GoodSide::low ? 1.0 : -1.0;
  return {point.result.evaluation.objective, sign * point.limited_value};
}

bool ParetoPoint::keeps_limits() const {
  return result.max_violation <= Tolerances().violation &&
         (result.is_optimum() || result.status == Status::stalled);
}

void mark_dominated(std::vector<ParetoPoint>& points, GoodSide side) {
  std::vector<Goals> goals;
  for (const ParetoPoint& point : points) {
    if (point.keeps_limits()) goals.push_back(goals_of(point, side));
  }
  const FrontScale scale(goals);
  for (ParetoPoint& point : points) {
    if (!point.keeps_limits()) continue;
    point.is_dominated = std::ranges::any_of(points, [&](const ParetoPoint& other) {
      const Limits limits = other.limit == point.limit ? Limits::same : Limits::different;
      return other.keeps_limits() &&
             scale.dominates(goals_of(other, side), goals_of(point, side), limits);
    });
  }
}

std::optional<std::size_t> find_knee(const std::vector<ParetoPoint>& points, GoodSide side) {
  std::vector<std::size_t> counted;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].keeps_limits() && !points[i].is_dominated) counted.push_back(i);
  }
  if (counted.size() < 3) return std::nullopt;
  std::vector<Goals> goals;
  for (const std::size_t i : counted) goals.push_back(goals_of(points[i], side));
  const FrontScale scale(goals);
  if (!scale.is_traded()) return std::nullopt;
  constexpr double straight = 0.05;  // distance from the line, both goals over their ranges
  std::optional<std::size_t> knee;
  double furthest = straight;
  for (std::size_t k = 0; k < counted.size(); ++k) {
    // 0 at the end where a goal is small, 1 at the other.
    const double u = (goals[k][0] - scale.objective().low) * scale.objective().per_range();
    const double v = (goals[k][1] - scale.limited().low) * scale.limited().per_range();
    const double distance = (1.0 - u - v) / std::numbers::sqrt2;
    if (distance <= furthest) continue;
    furthest = distance;
    knee = counted[k];
  }
  return knee;
}

std::vector<std::size_t> varied_rows(const ProblemFile& problem) {
  std::vector<std::size_t> rows = constraints_of_limit(problem, problem.pareto->constraint);
  if (rows.empty()) throw InputError("/pareto/constraint names no constraint");
  return rows;
}

GoodSide good_side(const ProblemFile& problem) {
  return problem.constraints[varied_rows(problem).front()].upper ? GoodSide::low : GoodSide::high;
}

void set_limit(ProblemFile& problem, double limit) {
  for (const std::size_t row : varied_rows(problem)) {
    ConstraintSettings& constraint = problem.constraints[row];
    (constraint.upper ? constraint.upper : constraint.lower) = limit;
  }
}

double limited_value(const ProblemFile& problem, const Eigen::VectorXd& constraints) {
  const Eigen::VectorXd values = constraints(varied_rows(problem));
  return good_side(problem) == GoodSide::low ? values.maxCoeff() : values.minCoeff();
}

double multiplier_of_limit(const ProblemFile& problem, const Eigen::VectorXd& multipliers) {
  return multipliers(varied_rows(problem)).sum();
}

bool can_exchange_goals(const ProblemFile& problem) {
  if (!problem.pareto->goals.empty()) return true;
  if (problem.has_cases()) return false;
  const ConstraintSettings& limited = problem.constraints[varied_rows(problem).front()];
  return !limited.response.empty() && limited.deviations == 0.0;
}

ProblemFile with_exchanged_goals(ProblemFile problem, double objective_limit) {
  const std::vector<Objective> goals = problem.pareto->goals;
  const Objective objective = goals.empty() ? *problem.objective : goals[0];
  Objective limited;
  if (goals.empty()) {
    const ConstraintSettings& limit = problem.constraints[varied_rows(problem).front()];
    limited = {limit.response, limit.upper ? Aim::minimize : Aim::maximize};
  } else {
    limited = goals[1];
  }
  const std::string name = problem.pareto->constraint;
  remove_limit(problem, name);
  set_objective(problem, limited);
  add_limit(problem, objective, objective.sign() * objective_limit, name);
  return problem;
}

}  // namespace pleuel
