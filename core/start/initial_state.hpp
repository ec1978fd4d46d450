#pragma once

#include <limits>

#include "core/start/assembly.hpp"

namespace pleuel {

/// Loads that act at this time are in equilibrium with elastic coordinates that start in it: their
/// values at t = 0 may be others. It differs from zero by less than round-off.
inline constexpr double just_before_start = -std::numeric_limits<double>::min();

/// Whether a load jumps at t = 0.
bool jumps_at_start(Mechanism& mechanism, State state);

/// Consistent initial values: positions by assembly (the closest to the guess with Φ = 0),
/// velocities (the closest with Φ̇ = 0), accelerations and multipliers from R = 0 with Φ̈ = 0; where
/// the mechanism asks for it, elastic coordinates in equilibrium with what acts just before t = 0
/// (equilibrium.hpp).
/// @param similar  a start beside which an equilibrium is looked for first; null: none is known
/// @throws SimulationError if the mechanism cannot be assembled or is singular
InitialState initial_state(Mechanism& mechanism, const State* similar = nullptr);

/// Elastic coordinates in equilibrium with what acts just before t = 0, and with nothing that jumps
/// then, whether the mechanism asks for it or not; stable or not. Vibrations are small about such a
/// state only.
/// @throws SimulationError if none is found
InitialState equilibrium_state(Mechanism& mechanism);

}  // namespace pleuel
