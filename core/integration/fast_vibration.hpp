#pragma once

#include <Eigen/Core>

#include "core/integration/mechanism.hpp"

namespace pleuel {

/// What a sudden change of the forces does to a mechanism at once, and what its elastic bodies do
/// faster than steps can follow: they vibrate about their new equilibrium. Of the undamped modes ω,
/// frozen at a state, only those count that are fast against σ, with the weights (ω²/(σ² + ω²))².
struct FastVibration {
  Eigen::VectorXd a, lambda;  ///< all that accelerates at once, and the multipliers beside it
  /// From there to the equilibrium of the fast modes, which they pass as far again.
  Eigen::VectorXd settled_q, settled_a, settled_lambda;
  double frequency = 0.0;      ///< of those that deform most [rad/s]
  double damping_ratio = 0.0;  ///< of these

  /// How far the first swing goes beyond the equilibrium, over the way to it.
  double overshoot() const;
};

/// @param state   where the forces change: positions, velocities and the instant behind
/// @param change  of the residual at a fixed state, constraints on acceleration level, n + m
/// @param sigma   [rad/s]
/// @returns nothing fast (settled_q is zero) where the equations are singular
FastVibration fast_vibration(const Mechanism& mechanism, const State& state,
                             const Eigen::VectorXd& change, double sigma);

}  // namespace pleuel
