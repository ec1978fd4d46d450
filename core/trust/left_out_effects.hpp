#pragma once

#include "core/trust/doubt.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Effects that were left out because little changed without them at the start design: at another
/// design the mechanism is simulated once more with all of them.
std::vector<Doubt> doubt_left_out_effects(const TrustedRun& run);

/// Geometric stiffening that the file does not forbid, but is not there because axial elasticity
/// is switched off: judged by the estimate of the axial force against Euler's load.
std::vector<Doubt> doubt_lost_stiffening(const TrustedRun& run);

/// Adds to the error of each response what the effects change that are left out by a tolerance: by
/// one more simulation with all of them.
void add_left_out_effects(const TrustedRun& run, std::vector<std::optional<ErrorBar>>& errors);

}  // namespace pleuel
