#pragma once

#include <vector>

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Whether the response `buckling` of a member says more than is true of the mechanism: it takes the
/// member as pinned at both ends, by itself; the rod of a hydraulic cylinder buckles together with
/// its barrel. Told where the mechanism buckles by smaller loads than the limit of the response is
/// for, or without a limit by less than twice its loads. Its factor is that of linear buckling at
/// the instant of the peak (elastic_stability.hpp), in the coordinates of the motion: in a plane, of
/// buckling in it. Drives hold. Not serious: the response is what it says it is. Nothing is said of
/// mechanisms with springs, nor without geometric stiffening.
std::vector<Finding> check_promised_buckling(const TrustedRun& run);

}  // namespace pleuel
