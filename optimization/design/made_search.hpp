#pragma once

#include "optimization/design/design_solve.hpp"
#include "optimization/design/made_bodies.hpp"
#include "optimization/evaluation_store.hpp"

namespace pleuel {

/// Moves a design towards the optimum with few calls of what makes the bodies: searches with
/// continued bodies within a region in which they are trusted, has the bodies made at the design
/// that is found, and goes on from there, until the design stays (to 1e-3). The region grows or
/// shrinks by how well the next bodies were foretold, and is no wider than four steps such as the last.
/// @param x       that the bodies were made for
/// @param before  effort and history of what was done before; goes on with that of the searches
/// @returns       a design that the bodies were made for
Eigen::VectorXd search_between_calls(MadeBodies& bodies, const Eigen::VectorXd& x,
                                     const SolveOptions& options, const Execution& execution,
                                     Result& before, const Observer& observer,
                                     const Notice& notice);

}  // namespace pleuel
