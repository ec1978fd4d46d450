#pragma once

#include <vector>

#include "core/trust/concerned_beam.hpp"
#include "core/trust/doubt.hpp"

namespace pleuel {

/// Beams that bend or twist so far against their frames that more frames may change something, and
/// that can be divided: not those with damping of the motion against one frame.
/// @returns those that turn most first
std::vector<ConcernedBeam> find_far_bending(const TrustedRun& run);

/// Bodies that are stretched or bent beyond what linear elasticity is for, where no variant can tell
/// what that changes: stretched by more than 1 %, or bent and not to be divided.
std::vector<Doubt> doubt_linear_elasticity(const TrustedRun& run);

}  // namespace pleuel
