#pragma once

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Peaks that the steps pass over: where a load or the acceleration of a drive jumps, elastic
/// bodies swing beyond their new equilibrium, up to as far again (the dynamic factor of two). Of
/// those that do so within a step nothing is left, with twice and half of it neither. Which may do
/// so the equations about that instant tell (fast_vibration.hpp); what is missing is seen by one
/// more simulation, with short steps behind such jumps (sudden_jumps.hpp).
std::vector<Finding> check_unresolved_transients(const TrustedRun& run);

}  // namespace pleuel
