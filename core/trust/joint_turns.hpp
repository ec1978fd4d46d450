#pragma once

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Springs in joints in space that turn farther than half a turn from where they began: there the
/// angle is counted from −π to π, where motion in a plane counts whole turns, and the moment jumps.
std::vector<Finding> check_joint_turns(const TrustedRun& run);

}  // namespace pleuel
