#pragma once

#include "optimization/design/staged_solve.hpp"

namespace pleuel {

/// Whether a body is made anew for each design.
bool has_made_bodies(const ProblemFile& file);

/// solve_in_stages() where bodies are made anew for each design: with few calls of what makes them, as
/// they are continued between the designs that they were made for (core/scene/continued_body.hpp).
/// @pre has_made_bodies(file)
StagedSolution solve_with_made_bodies(const ProblemFile& file, const Eigen::VectorXd& start,
                                      const SearchSetup& setup);

}  // namespace pleuel
