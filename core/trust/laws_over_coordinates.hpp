#pragma once

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Loads that are functions of the coordinate of a joint or the elongation of a spring, as cogging or
/// the gas force of a crank, or of its rate, of which the steps pass over most of a tooth or peak: what
/// acts between two instants is not seen, and runs with other steps may miss the same. Less than that
/// they do see.
std::vector<Finding> check_laws_over_coordinates(const TrustedRun& run);

}  // namespace pleuel
