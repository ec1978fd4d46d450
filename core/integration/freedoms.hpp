#pragma once

#include "core/integration/mechanism.hpp"

namespace pleuel {

/// How rigid motion is held: the coordinates of frames and point masses against the constraints
/// that act on them while bodies do not deform.
struct Freedoms {
  int coordinates = 0;  ///< of rigid motion
  int constraints = 0;  ///< rows of Φ that are independent for rigid motion

  int free() const { return coordinates - constraints; }
};

/// At a state: in a singular position, such as a dead centre, fewer constraints are independent.
/// By a rank-revealing QR decomposition of Φ_q: for descriptions, not for loops.
Freedoms rigid_freedoms(const Mechanism& mechanism, const State& state);

}  // namespace pleuel
