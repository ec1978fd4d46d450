#include "optimization/scaling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/eager_matrices.hpp"

namespace pleuel {

namespace {

/// Backends see variables that may cross their range in steps of order one; the audit looks closer.
constexpr double part_of_range_for_backends = 0.1;
constexpr double part_of_range_for_audit = 0.01;

double positive_or(double value, double fallback) {
  return value > 0.0 ? value : fallback;
}

bool has_range(const Variable& variable) {
  return variable.has_lower() && variable.has_upper();
}

/// Whether its value alone has to say what is much of it.
bool has_no_scale(const Variable& variable) {
  return !has_range(variable) && variable.magnitude == 0.0;
}

double variable_scale(const Variable& variable, double x, double part_of_range) {
  if (variable.magnitude > 0.0) return variable.magnitude;
  if (variable.is_fixed()) return positive_or(std::abs(x), 1.0);
  if (!has_range(variable))
    return positive_or(std::max(std::abs(x), std::abs(variable.start)), 1.0);
  const double range = variable.upper - variable.lower;
  return std::clamp(std::abs(x), part_of_range * range, range);
}

Eigen::VectorXd scales_with(double part_of_range, const Problem& problem,
                            const Eigen::VectorXd& x) {
  Eigen::VectorXd scales(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    scales[i] = variable_scale(problem.variables()[i], x[i], part_of_range);
  }
  return scales;
}

double largest_limit(const Constraint& constraint) {
  return std::max(constraint.has_lower() ? std::abs(constraint.lower) : 0.0,
                  constraint.has_upper() ? std::abs(constraint.upper) : 0.0);
}

}  // namespace

Eigen::VectorXd variable_scales(const Problem& problem, const Eigen::VectorXd& x) {
  return scales_with(part_of_range_for_backends, problem, x);
}

Eigen::VectorXd local_scales(const Problem& problem, const Eigen::VectorXd& x) {
  Eigen::VectorXd scales = scales_with(part_of_range_for_audit, problem, x);
  double largest = 0.0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (has_no_scale(problem.variables()[i])) largest = std::max(largest, scales[i]);
  }
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (has_no_scale(problem.variables()[i])) scales[i] = largest;
  }
  return scales;
}

Eigen::VectorXd constraint_scales(const Problem& problem, const Evaluation& evaluation,
                                  const Eigen::VectorXd& scales) {
  Eigen::VectorXd result(evaluation.constraints.size());
  for (Eigen::Index j = 0; j < result.size(); ++j) {
    const double change = evaluation.constraint_jacobian.row(j)
                              .transpose()
                              .cwiseProduct(scales)
                              .lpNorm<Eigen::Infinity>();
    const double value = std::abs(evaluation.constraints[j]);
    const double without_limit = positive_or(change, positive_or(value, 1.0));
    result[j] = positive_or(largest_limit(problem.constraints()[j]), without_limit);
  }
  return result;
}

Eigen::VectorXd scaled_objective_gradient(const Problem& problem, const Evaluation& evaluation,
                                          const Eigen::VectorXd& scales) {
  Eigen::VectorXd changes = evaluation.objective_gradient.cwiseProduct(scales);
  for (Eigen::Index i = 0; i < changes.size(); ++i) {
    if (problem.variables()[i].is_fixed()) changes[i] = 0.0;
  }
  return changes;
}

double objective_scale(const Problem& problem, const Evaluation& evaluation,
                       const Eigen::VectorXd& scales) {
  const double change =
      scaled_objective_gradient(problem, evaluation, scales).lpNorm<Eigen::Infinity>();
  return positive_or(std::max(std::abs(evaluation.objective), change), 1.0);
}

double objective_value_scale(const Evaluation& evaluation, const Evaluation& start) {
  return std::max({std::abs(evaluation.objective), 1e-3 * std::abs(start.objective),
                   std::numeric_limits<double>::min()});
}

double objective_curvature(const Problem& problem, const Eigen::VectorXd& x, const Evaluation& at,
                           const EvaluateBeside& evaluate) {
  constexpr double step = 1e-3;
  const Eigen::VectorXd s = variable_scales(problem, x);
  Eigen::VectorXd moved = x;
  for (Eigen::Index i = 0; i < s.size(); ++i) {
    const Variable& variable = problem.variables()[i];
    moved[i] += x[i] + step * s[i] <= variable.upper ? step * s[i] : -step * s[i];
  }
  const Evaluation* there = evaluate(within_bounds(problem, moved));
  if (there == nullptr) return 0.0;
  const Eigen::VectorXd change =
      scaled_objective_gradient(problem, *there, s) - scaled_objective_gradient(problem, at, s);
  return change.lpNorm<Eigen::Infinity>() / step;
}

std::vector<LimitSide> limit_sides(const Problem& problem, const Eigen::VectorXd& magnitudes) {
  std::vector<LimitSide> sides;
  for (std::size_t i = 0; i < problem.constraints().size(); ++i) {
    const Constraint& limits = problem.constraints()[i];
    const double magnitude = magnitudes[i];
    if (limits.has_upper()) sides.push_back({i, 1.0, limits.upper, magnitude});
    if (limits.has_lower()) sides.push_back({i, -1.0, limits.lower, magnitude});
  }
  return sides;
}

double max_violation(const Problem& problem, const Eigen::VectorXd& constraints,
                     const Eigen::VectorXd& scales) {
  double largest = 0.0;
  for (Eigen::Index j = 0; j < constraints.size(); ++j) {
    largest = std::max(largest, problem.constraints()[j].excess(constraints[j]) / scales[j]);
  }
  return largest;
}

}  // namespace pleuel
