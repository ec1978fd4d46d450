#pragma once

#include <vector>

#include <Eigen/Core>

namespace pleuel {

/// Which points of a curve are drawn: of each of equal stretches the lowest and the highest, so
/// that no peak is lost, both ends, and those that must be there. All of them if there are few.
/// @param most  about so many points at most
/// @param kept  indices that must be among them
/// @returns     indices, ascending
std::vector<int> thinned(const Eigen::VectorXd& values, int most,
                         const std::vector<int>& kept = {});

}  // namespace pleuel
