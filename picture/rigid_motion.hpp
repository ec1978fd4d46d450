#pragma once

#include "core/mobility/rigid_path.hpp"
#include "picture/motion.hpp"

namespace pleuel {

/// Bodies that do not deform, as the drives take them: to the end of the motion, or to where the
/// mechanism locks.
struct RigidMotion {
  RigidPath path;
  Motion motion;  ///< without stress; of one instant where nothing is driven
};

/// @param end   [s]
/// @param step  [s] of the simulation
RigidMotion rigid_motion(const Scene& scene, const Model& model, double end, double step);

}  // namespace pleuel
