#pragma once

#include "optimization/design/staged_solve.hpp"

namespace pleuel {

/// solve_in_stages(), with few calls of what makes bodies anew for each design, if there are such bodies:
/// they are continued between the designs that they were made for (core/scene/continued_body.hpp).
StagedSolution solve_with_made_bodies(const ProblemFile& file, const Eigen::VectorXd& start,
                                      const SearchSetup& setup);

}  // namespace pleuel
