#include "optimization/prices.hpp"

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

bool has_prices(const Result& result) {
  if (!result.evaluation.has_gradients()) return false;
  const bool is_optimum = result.status == Status::verified || result.status == Status::unresolved;
  return is_optimum || (result.status == Status::stalled && result.kkt_residual <= nearly_optimal);
}

}  // namespace pleuel
