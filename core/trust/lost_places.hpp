#pragma once

#include <vector>

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Places of joints and loads so near to an end of an elastic beam, a boundary of its segments or
/// another place that no node of the mesh is there (core/scene/beam_mesh.hpp): section forces do not
/// know what lies between both.
std::vector<Finding> check_lost_places(const TrustedRun& run);

}  // namespace pleuel
