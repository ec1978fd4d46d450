#pragma once

#include <vector>

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Limits on the largest value alone (or the smallest) of what has a sign without a meaning, as a
/// deflection or a torque, where the motion goes further to the other side: an optimum uses that.
std::vector<Finding> check_other_side(const TrustedRun& run);

}  // namespace pleuel
