#pragma once

#include <Eigen/Core>

namespace pleuel {

/// Undamped modes, K φ = λ M φ.
struct NaturalModes {
  Eigen::VectorXd lambda;  ///< ω², ascending [rad²/s²]
  Eigen::MatrixXd shapes;  ///< columns φ with φᵀ M φ = 1
};

/// Of symmetric K and positive definite M (lower triangles are read).
NaturalModes natural_modes(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass);

}  // namespace pleuel
