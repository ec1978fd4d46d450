#pragma once

#include <Eigen/Core>

#include "cli/text/json.hpp"
#include "core/scene/problem_file.hpp"

namespace pleuel {

/// How the mechanism moves at a design, one entry a load case:
///
///     [{"case": "", "time": […], "bodies": [{"name", "stations", "parts", "positions", "rotations", "stress"}]}]
///
/// of each body the rows of BodyTrack (picture/motion.hpp), one list an instant [SI].
/// @throws SimulationError
Json motion_document(const ProblemFile& problem, const Eigen::VectorXd& x);

}  // namespace pleuel
