#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.hpp"

namespace pleuel {

/// Where a joint or a load holds on to a body, or an initial deflection is given.
struct AttachedPoint {
  std::string name;  ///< of the joint or load, or "initial deflection"
  Point at;          ///< at t = 0, global axes [m]
};

/// Those of a body: joints first, in the order of the file.
std::vector<AttachedPoint> attached_points(const Scene& scene, const std::string& body);

}  // namespace pleuel
