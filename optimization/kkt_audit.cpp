#include "optimization/kkt_audit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "optimization/nonnegative_least_squares.hpp"
#include "optimization/scaling.hpp"

namespace pleuel {

namespace {

/// Slack, relative to the magnitude of the limit, beyond which a limit holds nothing.
constexpr double near_limit = 0.1;
/// Slope, relative to |f|, with respect to which all slopes are small: 1e-3 of it would change the
/// objective by 1e-4 across the whole range of a variable.
constexpr double flat = 1e-3;

/// One side of a constraint or of a variable: g = sign · (c − limit) / magnitude ≤ 0.
struct Limit {
  Eigen::Index index;
  double sign;
  double magnitude;
  double value;              ///< g
  Eigen::VectorXd gradient;  ///< s ∘ ∇g

  double slack() const { return std::max(0.0, -value); }
};

/// Adds the sides of lower ≤ value ≤ upper that are near.
/// @param side  index, magnitude, and the gradient s ∘ ∇c / magnitude; the rest is filled in here.
void add_near_limits(std::vector<Limit>& limits, const Limit& side, double value, double lower,
                     double upper) {
  const double above = (value - upper) / side.magnitude;
  const double below = (lower - value) / side.magnitude;
  if (above > -near_limit) {
    limits.push_back({side.index, 1.0, side.magnitude, above, side.gradient});
  }
  if (below > -near_limit) {
    limits.push_back({side.index, -1.0, side.magnitude, below, -side.gradient});
  }
}

std::vector<Limit> near_constraints(const Problem& problem, const Evaluation& evaluation,
                                    const Eigen::VectorXd& scales,
                                    const Eigen::VectorXd& variable_scales) {
  std::vector<Limit> limits;
  for (Eigen::Index j = 0; j < evaluation.constraints.size(); ++j) {
    const Constraint& constraint = problem.constraints()[j];
    const Eigen::VectorXd gradient =
        evaluation.constraint_jacobian.row(j).transpose().cwiseProduct(variable_scales) / scales[j];
    add_near_limits(limits, {j, 0.0, scales[j], 0.0, gradient}, evaluation.constraints[j],
                    constraint.lower, constraint.upper);
  }
  return limits;
}

std::vector<Limit> near_bounds(const Problem& problem, const Eigen::VectorXd& x,
                               const Eigen::VectorXd& variable_scales) {
  std::vector<Limit> limits;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Variable& variable = problem.variables()[i];
    add_near_limits(limits, {i, 0.0, variable_scales[i], 0.0, Eigen::VectorXd::Unit(x.size(), i)},
                    x[i], variable.lower, variable.upper);
  }
  return limits;
}

/// [s ∘ ∇g; diag(slack)], variables + limits × limits.
Eigen::MatrixXd system_matrix(const std::vector<Limit>& limits, Eigen::Index variables) {
  const auto count = static_cast<Eigen::Index>(limits.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(variables + count, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    matrix.col(k).head(variables) = limits[k].gradient;
    matrix(variables + k, k) = limits[k].slack();
  }
  return matrix;
}

/// Σ λ |g|: what slack leaves to be gained, and what violations gained already.
double complementarity(const std::vector<Limit>& limits, const Eigen::VectorXd& lambda) {
  double sum = 0.0;
  for (Eigen::Index k = 0; k < lambda.size(); ++k) sum += lambda[k] * std::abs(limits[k].value);
  return sum;
}

/// |f|, but not nothing where f vanishes at the optimum.
double objective_value_scale(const KnownDesign& design, const Evaluation& start) {
  return std::max({std::abs(design.evaluation.objective), 1e-3 * std::abs(start.objective),
                   std::numeric_limits<double>::min()});
}

double gradient_scale(const Problem& problem, const KnownDesign& design, const Evaluation& start,
                      const Eigen::VectorXd& scales) {
  const double here = scaled_objective_gradient(problem, design.evaluation, scales).norm();
  const double at_start = std::max(scaled_objective_gradient(problem, start, scales).norm(),
                                   std::abs(start.objective - design.evaluation.objective));
  const double value = objective_value_scale(design, start);
  return std::max(
      {here, std::min(at_start, 0.1 * value), flat * value, std::numeric_limits<double>::min()});
}

}  // namespace

KktAudit audit_kkt(const Problem& problem, const KnownDesign& design, const Evaluation& start,
                   const Eigen::VectorXd& scales) {
  const Eigen::VectorXd s = local_scales(problem, design.x);
  const Eigen::Index variables = s.size();
  std::vector<Limit> limits = near_constraints(problem, design.evaluation, scales, s);
  const std::size_t first_bound = limits.size();
  const std::vector<Limit> bounds = near_bounds(problem, design.x, s);
  limits.insert(limits.end(), bounds.begin(), bounds.end());

  const Eigen::MatrixXd matrix = system_matrix(limits, variables);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(matrix.rows());
  right.head(variables) = -s.cwiseProduct(design.evaluation.objective_gradient);
  const Eigen::VectorXd lambda = nonnegative_least_squares(matrix, right);

  KktAudit audit;
  audit.gradient_scale = gradient_scale(problem, design, start, s);
  const double stationarity = (matrix * lambda - right).head(variables).norm();
  const double value_scale = std::min(audit.gradient_scale, objective_value_scale(design, start));
  audit.residual =
      std::max(stationarity / audit.gradient_scale, complementarity(limits, lambda) / value_scale);
  audit.constraint_multipliers = Eigen::VectorXd::Zero(scales.size());
  audit.bound_multipliers = Eigen::VectorXd::Zero(variables);
  for (std::size_t k = 0; k < limits.size(); ++k) {
    Eigen::VectorXd& multipliers =
        k < first_bound ? audit.constraint_multipliers : audit.bound_multipliers;
    multipliers[limits[k].index] +=
        limits[k].sign * lambda[static_cast<Eigen::Index>(k)] / limits[k].magnitude;
  }
  return audit;
}

}  // namespace pleuel
