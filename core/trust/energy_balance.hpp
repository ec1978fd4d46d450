#pragma once

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Energy that comes from nowhere: steps too long for what moves, or a drive that jumps. Serious
/// from a tenth of the largest energy on: sudden loads on members that vibrate within a step give a
/// steady, wrong answer at any step that long.
std::vector<Finding> check_energy_balance(const TrustedRun& run);

}  // namespace pleuel
