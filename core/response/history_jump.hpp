#pragma once

#include <Eigen/Core>

namespace pleuel {

/// Whether a history jumps beside an instant, as forces do where friction turns round, a stop is
/// met or a law has a step: no parabola goes through a peak there. The slopes before and after each
/// instant tell: those of a smooth function change alike from one instant to the next, where it
/// jumps there is one change, its opposite within two steps, and then next to none; behind a jump
/// at the first instant there is none at once. Pulses that rise and fall within two steps look the
/// same. Within three instants of the ends of a history jumps are not told.
/// @param values  a row a channel
bool jumps_beside(const Eigen::VectorXd& time, const Eigen::MatrixXd& values, Eigen::Index channel,
                  Eigen::Index step);

}  // namespace pleuel
