#pragma once

#include "core/integration/linear_solver.hpp"
#include "core/integration/mechanism.hpp"

namespace pleuel {

/// Initial values together with what their derivatives need.
struct InitialState {
  State state;
  /// μ of  W (q − q̂) + Φ_qᵀ μ = 0  and of  W (v − v̂) + Φ_qᵀ μ = 0; zero if the guess is consistent.
  Eigen::VectorXd position_multipliers, velocity_multipliers;
};

/// Consistent initial values: positions by assembly (the closest to the guess with Φ = 0),
/// velocities (the closest with Φ̇ = 0), accelerations and multipliers from R = 0 with Φ̈ = 0; where
/// the mechanism asks for it, elastic coordinates in equilibrium (equilibrium.hpp).
/// @throws SimulationError if the mechanism cannot be assembled or is singular
InitialState initial_state(Mechanism& mechanism);

/// [ W  Φ_qᵀ ; Φ_q  0 ] at a state: the matrix of velocity projection and, up to curvature, of
/// assembly.
void projection_matrix(const Mechanism& mechanism, const State& state, System::Matrix& matrix);

}  // namespace pleuel
