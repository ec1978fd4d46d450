#pragma once

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Beams with modal damping and geometric stiffening that bend far: their axial displacements hold
/// the shortening by bending, which a ratio of the axial modes damps as if it were stretch.
std::vector<Finding> check_modal_damping(const TrustedRun& run);

}  // namespace pleuel
