#pragma once

#include <optional>
#include <string>

#include "core/model/scene_geometry.hpp"
#include "core/scene/problem_file.hpp"

namespace pleuel {

/// A plane in which a whole mechanism moves.
struct MotionPlane {
  Eigen::Vector3d normal;
  Eigen::Matrix<double, 3, 2> basis;  ///< two unit vectors, right-handed with the normal
  Eigen::Vector3d point;              ///< a point of the plane [m]
};

struct PlaneAnalysis {
  std::optional<MotionPlane> plane;
  std::string reason;  ///< why there is one, or what leaves the plane
};

/// Whether a mechanism moves in one plane, to the last digit: geometry, joint axes, gravity and
/// principal axes of all sections are symmetric about it. An exact decision.
PlaneAnalysis find_motion_plane(const Scene& scene, const Design<double>& start);

/// The plane in which a mechanism is simulated; none in space.
/// @param spatial  what the file says of motion in space
/// @throws InputError if the mechanism is to stay in a plane, and does not
PlaneAnalysis decide_motion_plane(const Scene& scene, EffectChoice spatial,
                                  const Design<double>& start);

}  // namespace pleuel
