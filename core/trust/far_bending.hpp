#pragma once

#include <string>
#include <vector>

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// A beam for which it may count what the model leaves out.
struct ConcernedBeam {
  std::string name;
  double indicator = 0.0;  ///< of how much, beside other beams
};

/// Beams that bend or twist so far against their frames that more frames may change something, and
/// that can be divided: not those with damping of the motion against one frame.
/// @returns those that turn most first
std::vector<ConcernedBeam> find_far_bending(const TrustedRun& run);

/// Of these bodies, those that bend so far that 0.45 θ² exceeds 1 %: what is missed of the deflection of a
/// cantilever whose tip turns by θ.
/// @param why  no run with more frames can tell
std::vector<Finding> check_untold_bending(const TrustedRun& run,
                                          const std::vector<std::string>& bodies,
                                          const std::string& why);

/// Bodies that are stretched or bent beyond what linear elasticity is for, where no variant can tell
/// what that changes: stretched by more than 1 %, or bent and not to be divided.
std::vector<Finding> check_linear_elasticity(const TrustedRun& run);

}  // namespace pleuel
