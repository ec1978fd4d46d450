#pragma once

#include "core/mobility/rigid_path.hpp"
#include "core/scene/problem_file.hpp"
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

/// Of the mechanism of a problem at a design; nothing where nothing is driven or it cannot be assembled.
Motion rigid_motion(const ProblemFile& problem, const Eigen::VectorXd& x);

}  // namespace pleuel
