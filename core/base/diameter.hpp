#pragma once

#include <vector>

#include <Eigen/Core>

namespace pleuel {

/// The largest distance between two of some points; 0 of none or one. Pairs are gone through from
/// the points farthest from the middle inwards, and only as long as they can be farther apart than
/// the best so far: of most sets few of them.
double diameter(const std::vector<Eigen::Vector3d>& points);

}  // namespace pleuel
