#pragma once

#include <string>

#include <Eigen/Core>

#include "core/scene/point.hpp"
#include "core/scene/scene.hpp"

/// Where things of a scene are at t = 0.
namespace pleuel {

/// The point of the axis of a beam at a share of its length, 0 … 1 [m].
Eigen::Vector3d point_at(const BeamBody& beam, double share, const Design<double>& design);

/// The share of the length, 0 … 1, where the axis of the beam is nearest to a place.
double nearest_share(const BeamBody& beam, const Eigen::Vector3d& place,
                     const Design<double>& design);

/// A place in the axes of the body frame of an imported body [m].
Eigen::Vector3d local_point(const ImportedBody& body, const Eigen::Vector3d& place,
                            const Design<double>& design);

/// The diagonal of the box around all bodies and joints [m].
double extent(const Scene& scene, const Design<double>& design);

/// "(0.12, 0, 0)"
std::string describe(const Eigen::Vector3d& place);

}  // namespace pleuel
