#pragma once

#include "core/trust/doubt.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Straight members in space that buckle without a trace in the motion: the stiffness of the whole
/// mechanism with its loads, rigid parts and inertia forces (elastic_stability.hpp), at the
/// instants at which beams with geometric stiffening are pressed most, and where all that turns does
/// so alike, as shafts with disks, when that is fastest. Serious. Nothing is looked for below a
/// twentieth of the Euler load of two pins, nor in mechanisms of more than 600 coordinates, whose
/// stiffness would have to be a dense matrix.
std::vector<Doubt> doubt_unstable_members(const TrustedRun& run);

}  // namespace pleuel
