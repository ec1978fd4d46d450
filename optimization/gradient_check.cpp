#include "optimization/gradient_check.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "optimization/scaling.hpp"

namespace pleuel {

namespace {

constexpr double step = 1e-3;
constexpr double least_magnitude = 1e-2;  ///< part of s that replaces |x| near zero

/// A direction with entries of generic size, the same in every run. The engine's raw numbers are
/// prescribed by the standard, unlike those of its distributions.
Eigen::VectorXd generic_direction(const Problem& problem, const Eigen::VectorXd& x,
                                  double orientation) {
  std::mt19937 engine;
  const Eigen::VectorXd s = local_scales(problem, x);
  Eigen::VectorXd direction(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double part = 0.5 + 0.5 * static_cast<double>(engine()) / std::mt19937::max();
    const double sign = engine() % 2 == 0 ? orientation : -orientation;
    const double size = part * std::clamp(std::abs(x[i]), least_magnitude * s[i], s[i]);
    const Variable& variable = problem.variables()[i];
    const auto is_inside = [&](double component) {
      const double far = x[i] + 2.0 * step * component;
      return far >= variable.lower && far <= variable.upper;
    };
    direction[i] = is_inside(sign * size)    ? sign * size
                   : is_inside(-sign * size) ? -sign * size
                                             : 0;
  }
  return direction;
}

/// Differences of the objective (first) and of the constraints along the direction.
std::optional<Eigen::VectorXd> differences(EvaluationCache& cache, const KnownDesign& design,
                                           const Eigen::VectorXd& direction) {
  const auto values = [](const Evaluation& evaluation) {
    Eigen::VectorXd all(1 + evaluation.constraints.size());
    all << evaluation.objective, evaluation.constraints;
    return all;
  };
  const Evaluation* near = cache.evaluate(design.x + step * direction, Request::values);
  if (near == nullptr) return std::nullopt;
  const Eigen::VectorXd near_values = values(*near);
  const Evaluation* far = cache.evaluate(design.x + 2.0 * step * direction, Request::values);
  if (far == nullptr) return std::nullopt;
  return (-3.0 * values(design.evaluation) + 4.0 * near_values - values(*far)) / (2.0 * step);
}

/// |error| of the directional derivatives, each weighted with its multiplier (1 for the objective).
Eigen::VectorXd weighted_errors(const Eigen::VectorXd& difference, const KnownDesign& design,
                                const KktAudit& audit, const Eigen::VectorXd& direction) {
  Eigen::VectorXd derivative(difference.size());
  derivative << design.evaluation.objective_gradient.dot(direction),
      design.evaluation.constraint_jacobian * direction;
  Eigen::VectorXd weights(difference.size());
  weights << 1.0, audit.constraint_multipliers;
  return (difference - derivative).cwiseProduct(weights).cwiseAbs();
}

}  // namespace

GradientCheck check_gradients(EvaluationCache& cache, const KnownDesign& design,
                              const KktAudit& audit) {
  const Problem& problem = cache.problem();
  const Eigen::VectorXd s = local_scales(problem, design.x);
  const double dimension = std::sqrt(static_cast<double>(design.x.size()));
  GradientCheck check;
  for (const double orientation : {1.0, -1.0}) {
    const Eigen::VectorXd direction = generic_direction(problem, design.x, orientation);
    const double length = direction.cwiseQuotient(s).norm();
    if (length == 0.0) return {true, 0.0, ""};  // every variable is fixed
    const auto difference = differences(cache, design, direction);
    if (!difference) continue;
    check.is_possible = true;
    Eigen::Index worst = 0;
    const double largest = weighted_errors(*difference, design, audit, direction).maxCoeff(&worst);
    const double error = dimension * largest / (length * audit.gradient_scale);
    if (error < check.error) continue;
    check.error = error;
    check.worst = worst == 0 ? problem.objective_name() : problem.constraints()[worst - 1].name;
  }
  return check;
}

}  // namespace pleuel
