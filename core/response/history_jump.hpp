#pragma once

#include <Eigen/Core>

namespace pleuel {

/// Whether a history jumps beside an instant, as forces do where friction turns round, a stop is met
/// or a law has a step: no parabola goes through a peak there. The slopes before and after each instant
/// tell: those of a smooth function change alike from one instant to the next, where it jumps there is
/// one change and its opposite; behind a jump at the first instant there is none. Told of jumps that take up to two steps, and of what swings within less
/// than five or rises and falls within two.
/// @param values  a row a channel
bool jumps_beside(const Eigen::VectorXd& time, const Eigen::MatrixXd& values, Eigen::Index channel,
                  Eigen::Index step);

}  // namespace pleuel
