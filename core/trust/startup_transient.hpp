#pragma once

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Peaks that are those of the start: elastic bodies which begin undeformed, under loads and speeds
/// that are there at once, vibrate about the deformation that these would have made, up to twice as
/// far. Such peaks are compared with those of a start in elastic equilibrium; laws that jump at t =
/// 0 (`step`) are meant and are sudden in both. The numbers are right, so this is never serious.
std::vector<Finding> check_startup_transient(const TrustedRun& run);

}  // namespace pleuel
