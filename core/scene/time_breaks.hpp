#pragma once

#include <vector>

#include "core/scene/scene.hpp"

namespace pleuel {

/// The instants at which something that acts is not smooth [s], in any order: where the value of a
/// load jumps or has a kink, or the acceleration of a drive. Only tables have some, so that they
/// are the same for all designs. Points of a table that are closer than four steps count as samples
/// of something smooth, unless their values jump.
/// @param step  of the simulation [s]
std::vector<double> time_breaks(const Scene& scene, double step);

}  // namespace pleuel
