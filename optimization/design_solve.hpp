#pragma once

#include "optimization/design_problem.hpp"
#include "optimization/solve.hpp"

namespace pleuel {

/// solve() for a problem file. The backends and the audit see each peak over time window by window
/// (peak_problem.hpp); result, history and observer speak of the constraints of the file.
/// @throws as solve()
Result solve_design(DesignProblem& problem, const SolveOptions& options,
                    const Observer& observer = {});

}  // namespace pleuel
