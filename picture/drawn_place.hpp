#pragma once

#include <string>

#include <Eigen/Core>

#include "core/scene/problem_file.hpp"

namespace pleuel {

/// A point of the scene as a place that moves with a body.
struct DrawnPlace {
  int body = -1;  ///< index in the scene; −1: the ground
  /// Along the length of a beam, 0 … 1; −1: not on the axis of a beam, `point` says where.
  double share = 0.0;
  /// In the frame of the body where it is not on the axis of a beam; of the ground global [m].
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
};

/// @param body    name of a body, or the ground
/// @param at      at t = 0, global axes [m]
DrawnPlace drawn_place(const Scene& scene, const std::string& body, const Point& at,
                       const Design<double>& design);

}  // namespace pleuel
