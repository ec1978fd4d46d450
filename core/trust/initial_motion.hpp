#pragma once

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Initial velocities and deflections of the file that are not those of the simulation: they are made
/// consistent with joints and drives, and elastic bodies begin without other elastic rates. What the
/// file gives and changes by more than a percent is named.
std::vector<Finding> check_initial_motion(const TrustedRun& run);

}  // namespace pleuel
