#pragma once

#include <vector>

#include "core/trust/doubt.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Beams that are too stubby for responses that rest on their bending stiffness: deflection,
/// elastic energy, buckling and frequencies of the beam, positions, deflections, elastic energy and
/// frequencies of the mechanism as far as the beam has a part in them; and its stresses, and forces and moments of joints and
/// drives, where these hold more than rigid bodies need. Of beams that have shear only lateral
/// buckling, which leaves it out.
std::vector<Doubt> doubt_shear_range(const TrustedRun& run);

}  // namespace pleuel
