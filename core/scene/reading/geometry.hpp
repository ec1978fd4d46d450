#pragma once

#include <string>

#include <Eigen/Core>

#include "core/scene/scene.hpp"

/// Where things of a scene are at t = 0.
namespace pleuel {

/// [m]
Eigen::Vector3d position(const Point& point, const Design<double>& design);

/// The node of the beam that is nearest to a place [m].
Eigen::Vector3d nearest_node(const BeamBody& beam, const Eigen::Vector3d& place,
                             const Design<double>& design);

/// The diagonal of the box around all bodies and joints [m].
double extent(const Scene& scene, const Design<double>& design);

/// "(0.12, 0, 0)"
std::string describe(const Eigen::Vector3d& place);

}  // namespace pleuel
