#pragma once

#include "core/integration/linear_solver.hpp"
#include "core/integration/mechanism.hpp"

namespace pleuel {

/// Consistent initial values: positions by assembly (the closest to the guess with Φ = 0), velocities
/// (the closest with Φ̇ = 0), accelerations and multipliers from R = 0 with Φ̈ = 0.
/// @throws SimulationError if the mechanism cannot be assembled or is singular
State initial_state(Mechanism& mechanism);

/// [ W  Φ_qᵀ ; Φ_q  0 ] at a state: the matrix of assembly and velocity projection.
void assembly_matrix(Mechanism& mechanism, const State& state, System::Matrix& matrix);

}  // namespace pleuel
