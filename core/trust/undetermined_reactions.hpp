#pragma once

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Reactions of joints that hold more than they have to, as two hinges of a door do: the equations
/// of motion do not say which one takes how much (least_norm.hpp).
std::vector<Finding> check_undetermined_reactions(const TrustedRun& run);

}  // namespace pleuel
