#pragma once

#include <functional>
#include <vector>

#include "core/scene/problem_file.hpp"
#include "optimization/solve.hpp"

namespace pleuel {

/// The best design for one value of the limit that is varied.
struct ParetoPoint {
  double limit = 0.0;          ///< [SI]
  double limited_value = 0.0;  ///< of the constraint whose limit is varied [SI]
  double multiplier = 0.0;     ///< of that constraint: d(objective)/d(limit) = −multiplier
  bool is_dominated = false;   ///< another point is better in one goal and no worse in the other
  Result result;

  bool has_design() const { return result.evaluation.has_gradients(); }
};

/// Sees each point as it is found; dominance is known only at the end.
using ParetoObserver = std::function<void(const ParetoPoint&)>;

/// The trade-off between the objective and one limit by the ε-constraint method (Haimes, Lasdon &
/// Wismer 1971): the limit goes from `from` to `to` in equal steps, and each optimization starts
/// from the optimum before, the first from the start values. Every point is audited like any
/// optimum.
/// @param threads  simulations at a time, of gradients by differences
/// @returns the points that were found before a stop, if one was asked for
/// @throws Stopped before the first
/// @throws InputError if the problem has no pareto settings, variables or objective
std::vector<ParetoPoint> pareto_front(const ProblemFile& problem, const SolveOptions& options,
                                      const ParetoObserver& observer = {}, int threads = 1);

}  // namespace pleuel
