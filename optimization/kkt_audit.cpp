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

/// One side of a constraint or of a variable: g = sign · (c − limit) / magnitude ≤ 0.
struct Limit {
  Eigen::Index index;
  double sign;
  double magnitude;
  double slack;              ///< max(0, −g)
  Eigen::VectorXd gradient;  ///< s ∘ ∇g
};

/// Adds the sides of lower ≤ value ≤ upper that are near.
/// @param side  index, magnitude, and the gradient s ∘ ∇c / magnitude; the rest is filled in here.
void add_near_limits(std::vector<Limit>& limits, const Limit& side, double value, double lower,
                     double upper) {
  const double to_upper = std::max(0.0, (upper - value) / side.magnitude);
  const double to_lower = std::max(0.0, (value - lower) / side.magnitude);
  if (to_upper < near_limit) {
    limits.push_back({side.index, 1.0, side.magnitude, to_upper, side.gradient});
  }
  if (to_lower < near_limit) {
    limits.push_back({side.index, -1.0, side.magnitude, to_lower, -side.gradient});
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
    matrix(variables + k, k) = limits[k].slack;
  }
  return matrix;
}

double gradient_scale(const KnownDesign& design, const Evaluation& start,
                      const Eigen::VectorXd& variable_scales) {
  const double here = variable_scales.cwiseProduct(design.evaluation.objective_gradient).norm();
  const double at_start = variable_scales.cwiseProduct(start.objective_gradient).norm();
  const double value =
      std::max(std::abs(design.evaluation.objective), 1e-3 * std::abs(start.objective));
  return std::max({here, std::min(at_start, value), std::numeric_limits<double>::min()});
}

}  // namespace

KktAudit audit_kkt(const Problem& problem, const KnownDesign& design, const Evaluation& start,
                   const Eigen::VectorXd& scales) {
  const Eigen::VectorXd s = variable_scales(problem, design.x);
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
  audit.gradient_scale = gradient_scale(design, start, s);
  audit.residual = (matrix * lambda - right).norm() / audit.gradient_scale;
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
