#pragma once

#include "optimization/design_problem.hpp"
#include "optimization/solve.hpp"

namespace pleuel {

/// solve() for a problem file. First with its constraints as they are; if that ends without a
/// verified optimum, the maximum of some response has a kink there more often than not, and the
/// backend goes on with each peak over time window by window (peak_problem.hpp). Result, history
/// and observer speak of the constraints of the file.
/// @throws as solve()
Result solve_design(DesignProblem& problem, const SolveOptions& options,
                    const Observer& observer = {});

}  // namespace pleuel
