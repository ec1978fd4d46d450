#pragma once

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Bodies that nothing drives and that turn by more than a quarter of a turn within a step: at whole
/// turns a step they seem to stand still.
std::vector<Finding> check_fast_turning(const TrustedRun& run);

}  // namespace pleuel
