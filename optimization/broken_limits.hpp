#pragma once

#include <string>

#include <Eigen/Core>

#include "optimization/problem.hpp"

namespace pleuel {

/// "rod_bow = 1.18 mm exceeds its upper limit 0.05 mm, …": all limits that are broken, the worst
/// first, each name once: rows of one name are peaks of one response. Empty if all are kept.
/// @param constraints  values c [SI]
/// @param scales       magnitudes C of the constraints
/// @param allowed      violation that does not count, relative to C
std::string broken_limits(const Problem& problem, const Eigen::VectorXd& constraints,
                          const Eigen::VectorXd& scales, double allowed);

}  // namespace pleuel
