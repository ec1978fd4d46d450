#pragma once

#include "core/trust/doubts.hpp"

namespace pleuel {

/// Effects that were left out because little changed without them at the start design: at another
/// design the mechanism is simulated once more with all of them.
std::vector<Doubt> doubt_left_out_effects(const TrustedRun& run);

/// Geometric stiffening that the file does not forbid, but is not there because axial elasticity
/// is switched off: judged by the estimate of the axial force against Euler's load.
std::vector<Doubt> doubt_lost_stiffening(const TrustedRun& run);

/// Adds what effects that are left out by a tolerance change of each response at most: the sum of
/// the largest changes that were measured where the decision was made.
void add_left_out_effects(const TrustedRun& run, std::vector<std::optional<ErrorBar>>& errors);

}  // namespace pleuel
