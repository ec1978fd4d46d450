#include "optimization/scaling.hpp"

#include <algorithm>
#include <cmath>

namespace pleuel {

namespace {

/// Bounds beyond this are a habit of writing "none".
constexpr double practically_infinite = 1e19;
constexpr double smallest_part_of_range = 0.1;

bool is_limited(double limit) {
  return std::abs(limit) < practically_infinite;
}

double positive_or(double value, double fallback) {
  return value > 0.0 ? value : fallback;
}

double variable_scale(const Variable& variable, double x) {
  const double magnitude = std::abs(x);
  const double range = variable.upper - variable.lower;
  if (!is_limited(variable.lower) || !is_limited(variable.upper) || range <= 0.0) {
    return positive_or(magnitude, 1.0);
  }
  return std::clamp(magnitude, smallest_part_of_range * range, range);
}

double largest_limit(const Constraint& constraint) {
  double largest = 0.0;
  for (const double limit : {constraint.lower, constraint.upper}) {
    if (is_limited(limit)) largest = std::max(largest, std::abs(limit));
  }
  return largest;
}

}  // namespace

Eigen::VectorXd variable_scales(const Problem& problem, const Eigen::VectorXd& x) {
  Eigen::VectorXd scales(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    scales[i] = variable_scale(problem.variables()[i], x[i]);
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

double objective_scale(const Evaluation& evaluation, const Eigen::VectorXd& scales) {
  const double change =
      evaluation.objective_gradient.cwiseProduct(scales).lpNorm<Eigen::Infinity>();
  return positive_or(std::max(std::abs(evaluation.objective), change), 1.0);
}

double max_violation(const Problem& problem, const Eigen::VectorXd& constraints,
                     const Eigen::VectorXd& scales) {
  double largest = 0.0;
  for (Eigen::Index j = 0; j < constraints.size(); ++j) {
    const Constraint& limits = problem.constraints()[j];
    const double excess = std::max(constraints[j] - limits.upper, limits.lower - constraints[j]);
    largest = std::max(largest, excess / scales[j]);
  }
  return largest;
}

}  // namespace pleuel
