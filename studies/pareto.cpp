#include "studies/pareto.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"
#include "core/base/find_named.hpp"
#include "core/base/stop.hpp"
#include "optimization/design_problem.hpp"
#include "optimization/design_solve.hpp"

namespace pleuel {

namespace {

/// Optima agree to about this, relative: what differs by less is the same.
constexpr double resolution = 1e-4;

Eigen::Index varied_row(const ProblemFile& problem) {
  const ConstraintSettings* found = find_named(problem.constraints, problem.pareto->constraint);
  if (!found) throw InputError("/pareto/constraint names no constraint");
  return found - problem.constraints.data();
}

void set_limit(ConstraintSettings& constraint, double limit) {
  (constraint.upper ? constraint.upper : constraint.lower) = limit;
}

/// Bounds are kept exactly: an optimum may miss them by rounding.
void start_from(const Eigen::VectorXd& x, std::vector<DesignVariable>& variables) {
  for (std::size_t i = 0; i < variables.size(); ++i) {
    variables[i].start =
        std::clamp(x(static_cast<Eigen::Index>(i)), variables[i].lower, variables[i].upper);
  }
}

ParetoPoint find_point(const ProblemFile& problem, Eigen::Index row, double limit,
                       const SolveOptions& options, int threads) {
  DesignProblem design_problem(problem, threads);
  ParetoPoint point;
  point.limit = limit;
  point.result = solve_design(design_problem, options);
  if (point.has_design()) {
    point.limited_value = point.result.evaluation.constraints(row);
    point.multiplier = point.result.constraint_multipliers(row);
  }
  return point;
}

bool is_within_limits(const ParetoPoint& point) {
  if (point.result.max_violation > Tolerances().violation) return false;
  const Status status = point.result.status;
  return status == Status::verified || status == Status::unresolved || status == Status::stalled;
}

bool dominates(const ParetoPoint& one, const ParetoPoint& other, GoodSide side) {
  const double sign = side == GoodSide::low ? 1.0 : -1.0;
  const double gain = other.result.evaluation.objective - one.result.evaluation.objective;
  const double limited_gain = sign * (other.limited_value - one.limited_value);
  const double least = resolution * std::abs(one.result.evaluation.objective);
  const double least_limited = resolution * std::abs(one.limited_value);
  return gain >= -least && limited_gain >= -least_limited &&
         (gain > least || limited_gain > least_limited);
}

}  // namespace

void mark_dominated(std::vector<ParetoPoint>& points, GoodSide side) {
  for (ParetoPoint& point : points) {
    if (!is_within_limits(point)) continue;
    point.is_dominated = std::any_of(points.begin(), points.end(), [&](const ParetoPoint& other) {
      return is_within_limits(other) && dominates(other, point, side);
    });
  }
}

std::vector<ParetoPoint> pareto_front(const ProblemFile& problem, const SolveOptions& options,
                                      const ParetoObserver& observer, int threads) {
  if (!problem.pareto) throw InputError("/pareto is missing: it says which limit to vary");
  const ParetoSettings& settings = *problem.pareto;
  const Eigen::Index row = varied_row(problem);
  ProblemFile varied = problem;
  ConstraintSettings& constraint = varied.constraints[static_cast<std::size_t>(row)];
  std::vector<ParetoPoint> points;
  for (int i = 0; i < settings.points; ++i) {
    const double limit = std::lerp(settings.from, settings.to,
                                   static_cast<double>(i) / std::max(settings.points - 1, 1));
    set_limit(constraint, limit);
    try {
      points.push_back(find_point(varied, row, limit, options, threads));
    } catch (const Stopped&) {
      if (points.empty()) throw;
      break;
    }
    if (is_within_limits(points.back())) start_from(points.back().result.x, varied.variables);
    if (observer) observer(points.back());
  }
  mark_dominated(points, constraint.upper ? GoodSide::low : GoodSide::high);
  return points;
}

}  // namespace pleuel
