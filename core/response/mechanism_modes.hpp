#pragma once

#include "core/integration/mechanism.hpp"

/// Small vibrations of a whole mechanism about an instant of its motion.
namespace pleuel {

/// Matrices of the equations of motion at a state, frozen there:
///     M ÿ + G ẏ + K y + Φ_qᵀ μ = 0,   Φ_q y = 0
/// M = R_a and K = R_q with the share of λ; G is the skew part of R_v: gyroscopic forces. Damping,
/// which is symmetric, is left out: frequencies are undamped, like those of a body. For rotation
/// vectors y is a right perturbation.
struct FrozenMechanism {
  Eigen::MatrixXd M, G, K;  ///< n × n
  Eigen::MatrixXd phi;      ///< Φ_q, m × n
};

FrozenMechanism freeze(const Mechanism& mechanism, const State& state);

/// The same on the motions that the joints and drives leave, y = Z z with Φ_q Z = 0 and Zᵀ M Z = 1:
///     z̈ + G ż + K z = 0
struct FreeVibration {
  Eigen::MatrixXd Z;     ///< n × free motions
  Eigen::MatrixXd G, K;  ///< Zᵀ G Z, Zᵀ K Z
};

/// @throws SimulationError if a free motion has no inertia
FreeVibration free_vibration(const FrozenMechanism& frozen);

/// Natural angular frequencies [rad/s], ascending: imaginary parts of the eigenvalues of
///     [ 0  w ; −K/w  −G ],   w² = ‖K‖
/// Free motions without stiffness (ω below 1e-6 of the largest), and unstable ones, have none.
Eigen::VectorXd frequencies_of(const FreeVibration& vibration);

/// Natural angular frequencies of a mechanism about a state [rad/s], ascending: drives and joints
/// hold, loads and gravity count. Exact for a mechanism at rest in equilibrium; about a motion, an
/// approximation for frequencies that are high against its rates, since coefficients are frozen.
Eigen::VectorXd mechanism_frequencies(const Mechanism& mechanism, const State& state);

}  // namespace pleuel
