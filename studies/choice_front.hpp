#pragma once

#include "core/scene/problem_file.hpp"
#include "studies/pareto_front.hpp"
#include "studies/point_searches.hpp"

/// Fronts of sizes that are chosen from lists, where all choices can be simulated.
namespace pleuel {

/// Whether there is nothing to design but sizes from lists, with at most 300 choices of them.
bool is_enumerable(const ProblemFile& problem);

/// Simulates every choice of sizes. The front is all of them that keep the limits and that no other
/// dominates, to round-off: that of the problem itself, not of searches. Of a limit that goes from
/// one value to another it is what is best at some limit between. Each point is judged like any
/// optimum.
/// @param problem  of two responses: that of trade_off_problem()
/// @throws Stopped before the first point
ParetoFront choice_front(const ProblemFile& problem, const SolveOptions& options,
                         const Execution& execution, const ParetoObserver& observer);

}  // namespace pleuel
