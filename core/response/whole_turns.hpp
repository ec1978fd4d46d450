#pragma once

#include <Eigen/Core>

#include "core/scene/problem_file.hpp"

namespace pleuel {

/// Whether the history of a response is an angle, which in space is known up to whole turns.
bool is_counted_angle(const ResponseSettings& response);

/// Adds whole turns to an angle over time, so that it changes by at most half a turn from one step
/// to the next. The first value stays; derivatives are those of the angle as it was.
/// @param history  1 × (steps + 1) [rad]
void count_turns(Eigen::MatrixXd& history);

}  // namespace pleuel
