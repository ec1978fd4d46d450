#include "optimization/prices.hpp"

#include <utility>

#include "core/base/eager_matrices.hpp"

namespace pleuel {

namespace {

constexpr double slack = 1e-3;
constexpr double nearly_optimal = 1e-2;

}  // namespace

Eigen::VectorXd prices_of(const Problem& problem, const Eigen::VectorXd& constraints,
                          const Eigen::VectorXd& multipliers, const Eigen::VectorXd& scales) {
  Eigen::VectorXd prices = multipliers;
  for (Eigen::Index j = 0; j < prices.size(); ++j) {
    const Constraint& limits = problem.constraints()[j];
    const double room =
        prices[j] > 0.0 ? limits.upper - constraints[j] : constraints[j] - limits.lower;
    if (room > slack * scales[j]) prices[j] = 0.0;
  }
  return prices;
}

void set_answer(Result& result, const Problem& problem, EvaluatedDesign design,
                const KktAudit& audit, const Eigen::VectorXd& scales) {
  result.constraint_multipliers =
      prices_of(problem, design.evaluation.constraints, audit.constraint_multipliers, scales);
  result.bound_multipliers = audit.bound_multipliers;
  result.kkt_residual = audit.residual;
  result.max_violation = design.max_violation;
  result.x = std::move(design.x);
  result.evaluation = std::move(design.evaluation);
}

void set_unproven_answer(Result& result, const Problem& problem, EvaluatedDesign design,
                         const Eigen::VectorXd& scales) {
  const KktAudit audit = audit_kkt(problem, design, design.evaluation, scales);
  set_answer(result, problem, std::move(design), audit, scales);
}

bool has_prices(const Result& result) {
  if (!result.evaluation.has_gradients()) return false;
  const bool is_optimum = result.status == Status::verified || result.status == Status::unresolved;
  return is_optimum || (result.status == Status::stalled && result.kkt_residual <= nearly_optimal);
}

}  // namespace pleuel
