#pragma once

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Natural frequencies of the whole mechanism that do not say what they seem to: the stress of
/// members that start undeformed though they are loaded or turn, modes out of the plane that cannot be
/// had, and those that are not high against the speed of the motion.
std::vector<Finding> check_frequencies(const TrustedRun& run);

}  // namespace pleuel
