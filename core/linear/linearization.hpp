#pragma once

#include <vector>

#include "core/linear/turning.hpp"

namespace pleuel {

/// Small motions y of a mechanism about a state, with coefficients as they are there:
///     M ÿ + G ẏ + K y + Φᵀ μ = 0,   Φ y = 0
/// counted in axes δq = T y, δv = T ẏ + V y, δa = T ÿ + P ẏ + Q y (turning.hpp), in which, with the
/// share of λ in R_q,
///     M = Tᵀ R_a T,  G = Tᵀ (R_a P + R_v T),  K = Tᵀ (R_a Q + R_v V + R_q T),  Φ = Φ_q T
/// All tangents are those of the terms: of forces that follow, damping, stress, gyroscopic forces.
struct Linearization {
  Eigen::MatrixXd M, G, K;  ///< n × n
  Eigen::MatrixXd phi;      ///< m × n
  bool is_damped = false;   ///< whether G has what is symmetric in it, as damping
  /// Rows of Φ that follow from the others: they are zero, and so are their multipliers.
  std::vector<int> left_out;
};

/// @param axes       in which y is counted
/// @param is_damped  else G is its skew part, as of natural frequencies, which are undamped
Linearization linearize(const Mechanism& mechanism, const State& state, const Turning& axes,
                        bool is_damped);

/// In axes that stand still (standing_axes()).
Linearization linearize(const Mechanism& mechanism, const State& state, bool is_damped = false);

}  // namespace pleuel
