#pragma once

#include <Eigen/Core>

namespace pleuel {

/// Limits r + A d ≤ 0 along a step d: residuals r and their slopes A (limits × variables).
struct LinearizedLimits {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd slopes;

  /// Σ max(0, r + A d)²
  double sum(const Eigen::VectorXd& step) const {
    return (residuals + slopes * step).cwiseMax(0.0).squaredNorm();
  }
};

/// The step that meets the limits as well as can be in the box −down ≤ d ≤ up,
///
///     argmin Σ max(0, r + A d)² + w² ‖max(0, d − up)‖² + w² ‖max(0, −down − d)‖² + λ ‖d‖²
///
/// with sides of the box so heavy (w = 30) that little is cut off in the end, and a λ = 1e-4 that
/// makes the step unique. A convex function of quadratic pieces: Newton's method with the second
/// derivatives of the piece at hand and an exact line search ends after finitely many steps
/// (Mangasarian, A finite Newton method for classification, 2002); each costs
/// O(limits × variables² + variables³).
Eigen::VectorXd violation_step(const LinearizedLimits& limits, const Eigen::VectorXd& down,
                               const Eigen::VectorXd& up);

}  // namespace pleuel
