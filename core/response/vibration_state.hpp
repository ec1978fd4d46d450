#pragma once

#include <string>

#include "core/start/initial_state.hpp"

namespace pleuel {

/// The state about which a mechanism vibrates.
struct VibrationState {
  InitialState initial;
  /// Why members are undeformed there, and not in equilibrium; empty if they are.
  std::string without_equilibrium;
};

/// Members in elastic equilibrium with the motion and what acts just before t = 0, however the
/// motion itself begins: about another state coefficients are not those of small vibrations, and
/// depend on the mesh. Equilibria that are not stable count, too; if there is none, members are
/// undeformed.
/// @throws SimulationError if the mechanism cannot be started at all
VibrationState vibration_state(Mechanism& mechanism);

}  // namespace pleuel
