#pragma once

#include "studies/front_gaps.hpp"
#include "studies/point_searches.hpp"

namespace pleuel {

/// Of sizes from lists, where all choices were simulated.
struct ChoiceCounts {
  int all = 0, failed = 0;  ///< failed: could not be simulated
  int feasible = 0;         ///< keep the limits other than the one that is varied
};

struct ParetoFront {
  std::vector<ParetoPoint> points;  ///< in the order of limits
  FrontGaps gaps;                   ///< of a front that was asked for a gap
  std::optional<ChoiceCounts> choices;
  bool is_whole = true;  ///< no stop was asked for before its end
};

/// The order in which points are found, and the one that each begins at: ends first, then the
/// middle of each gap from the nearer end of it.
struct ParetoOrder {
  std::vector<int> points;               ///< by their number on the front, from 0
  std::vector<std::optional<int>> from;  ///< place in `points`, before this one; none: the start
};
ParetoOrder pareto_order(int points);

/// Of a front between two responses: the problem that minimizes, or maximizes, the first of them,
/// with a limit on the second that is varied, after those of the file; it bears the name of that
/// response, or of its place if there is one. The limit on the worst of several load cases holds in
/// all of them. Another problem is as it was.
ProblemFile trade_off_problem(ProblemFile problem);

/// The trade-off between the objective and one limit by the ε-constraint method (Haimes, Lasdon &
/// Wismer 1971): the limit goes from `from` to `to` in equal steps. The optimizations at both ends
/// start from the start values, each other one from the optimum of a neighbour (pareto_order()), or
/// where that broke its limits from where that began. Each is a task of its own
/// (core/jobs/tasks.hpp); the points do not depend on the number of jobs. Every point is audited
/// like any optimum. Between two responses the ends are found first: the best design for each of
/// them, and of equally good ones (to 10⁻⁴ of their value) the best for the other; the limit on the
/// second goes from one to the other. Where both ends are the same there is one point: nothing is
/// to be traded. With a `gap` more points come between neighbours that are further apart
/// (front_gaps.hpp), in rounds: where they come follows from the points before alone. Where sizes
/// come from lists, each point is a choice of them (choose_sizes()); where nothing else is free and
/// the choices are few, the front is that of all choices.
/// @param problem  of two responses: that of trade_off_problem()
/// @returns what was found before a stop, if one was asked for
/// @throws Stopped before the first
/// @throws InputError if the problem has no pareto settings, variables or objective, or a gap of a front of
///         sizes that cannot all be simulated
ParetoFront pareto_front(const ProblemFile& problem, const SolveOptions& options,
                         const Execution& execution = {}, const ParetoObserver& observer = {});

}  // namespace pleuel
