#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/scene/scene.hpp"

namespace pleuel {

/// Where the points of bodies, joints and loads are that depend on design variables [m].
std::vector<Eigen::Vector3d> bound_points(const Scene& scene, const Design<double>& design);

}  // namespace pleuel
