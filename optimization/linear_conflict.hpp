#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace pleuel {

/// lower ≤ A x ≤ upper; infinite where there is no limit.
struct LinearLimits {
  Eigen::MatrixXd rows;          ///< A, limits × variables
  Eigen::VectorXd lower, upper;  ///< one a limit
};

/// Which limits contradict each other: no x within its bounds keeps all of them. Empty: some x does. That none
/// does is proven by multipliers y ≥ 0 of the rows B x ≤ b of limits and bounds with
///     Bᵀ y = 0,  bᵀ y < 0
/// (Farkas' lemma), which are sought by non-negative least squares; of few rows, as its solutions are.
/// @param lower, upper  finite bounds of x
std::vector<std::size_t> linear_conflict(const LinearLimits& limits, const Eigen::VectorXd& lower,
                                         const Eigen::VectorXd& upper);

}  // namespace pleuel
