#pragma once

#include <vector>

#include "core/trust/doubt.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Limits that the value exceeds (or, of lower ones, misses) more than ten-thousandfold: a plain
/// number is in SI units, so that a stress limit of 80 is 80 Pa.
std::vector<Doubt> doubt_far_limits(const TrustedRun& run);

}  // namespace pleuel
