#pragma once

#include <limits>

#include "core/integration/linear_solver.hpp"
#include "core/integration/mechanism.hpp"

namespace pleuel {

/// Initial values together with what their derivatives need.
struct InitialState {
  State state;
  /// μ of  W (q − q̂) + Φ_qᵀ μ = 0  and of  W (v − v̂) + Φ_qᵀ μ = 0; zero if the guess is consistent.
  Eigen::VectorXd position_multipliers, velocity_multipliers;
};

/// Loads that act at this time are in equilibrium with elastic coordinates that start in it: their
/// values at t = 0 may be others. It differs from zero by less than round-off.
inline constexpr double just_before_start = -std::numeric_limits<double>::min();

/// Whether a load jumps at t = 0.
bool jumps_at_start(Mechanism& mechanism, State state);

/// Consistent initial values: positions by assembly (the closest to the guess with Φ = 0),
/// velocities (the closest with Φ̇ = 0), accelerations and multipliers from R = 0 with Φ̈ = 0; where
/// the mechanism asks for it, elastic coordinates in equilibrium with what acts just before t = 0
/// (equilibrium.hpp).
/// @throws SimulationError if the mechanism cannot be assembled or is singular
InitialState initial_state(Mechanism& mechanism);

/// [ W  Φ_qᵀ ; Φ_q  0 ] at a state: the matrix of velocity projection and, up to curvature, of
/// assembly.
void projection_matrix(const Mechanism& mechanism, const State& state, System::Matrix& matrix);

}  // namespace pleuel
