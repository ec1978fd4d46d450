#pragma once

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Joints that would constrain a motion twice if they were aligned exactly, and are so nearly: a
/// motion is blocked by what is hardly a number of the file, with forces that are the larger the
/// smaller it is.
std::vector<Finding> check_misaligned_joints(const TrustedRun& run);

}  // namespace pleuel
