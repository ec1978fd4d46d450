#pragma once

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Beams whose bending moment makes them buckle out of the plane in which they bend, by
/// lateral–torsional buckling, which the equations of motion do not have. Mentioned from three
/// quarters of the critical load on, serious beyond it, unless the file says that the beam is held.
/// The section forces of each instant count as if they lasted, neighbours at joints as rigid. What
/// compression does alone, or with neighbours, is asked of the whole mechanism (stability.hpp).
/// Warping of sections helps short I beams: a bent beam is said to buckle only beyond what flanges
/// at the edges of its section could bear.
std::vector<Finding> check_sideways_buckling(const TrustedRun& run);

}  // namespace pleuel
