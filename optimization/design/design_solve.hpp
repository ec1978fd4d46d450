#pragma once

#include "optimization/design/design_problem.hpp"
#include "optimization/solve.hpp"

namespace pleuel {

/// find_optimum() for a problem file. Each attempt runs first with its constraints as they are; if
/// that ends without a verified optimum, but not far outside the limits, the maximum of some
/// response has a kink there more often than not, and the backend goes on with each peak over time
/// window by window and place by place, that of the objective too (peak_problem.hpp). Result,
/// history and observer speak of the objective and the constraints of the file. Where no optimum is
/// verified, the message names the peaks that tie.
/// @throws as solve()
Result solve_design(DesignProblem& problem, const SolveOptions& options,
                    const Observer& observer = {}, const Notice& notice = {});

/// The same for a problem in which nothing is free: its start, audited.
Result judge_design(DesignProblem& problem, const SolveOptions& options,
                    const Observer& observer = {});

/// The record with what it was simulated with; of several load cases with the smallest step and the
/// most elements.
EvaluationRecord simulated_with(const ProblemFile& file, EvaluationRecord record);

/// search() for a problem file: the records know its setting.
Result search_with_setting(DesignProblem& problem, const SolveOptions& options,
                           const Observer& observer);

/// Whether a search could evaluate its start.
inline bool has_moved(const Result& result) {
  return result.iterations > 0 && !result.history.front().has_failed();
}

}  // namespace pleuel
