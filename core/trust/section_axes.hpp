#pragma once

#include <vector>

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Beams close to the global z axis whose direction is a matter of the design, without a `reference`:
/// local y lies in the x–y plane by default, so that the section turns with the smallest inclination,
/// and by 90 degrees where the beam is exactly along z. Not for sections that bend alike both ways.
std::vector<Finding> check_section_axes(const TrustedRun& run);

}  // namespace pleuel
