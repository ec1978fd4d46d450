#pragma once

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Peaks of jerks that lie where the law of a drive has a corner in its acceleration: behind it the
/// accelerations of index 3 and of the stabilized index 2 ring for some steps by an amount of first
/// order in the step, whose rate is wrong by as much with any step.
std::vector<Finding> check_jerks_at_corners(const TrustedRun& run);

}  // namespace pleuel
