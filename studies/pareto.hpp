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
  /// Of that constraint: d(objective)/d(limit) = −multiplier. Only where has_prices(result).
  double multiplier = 0.0;
  bool is_dominated = false;  ///< another point is better in one goal and no worse in the other
  Result result;

  bool has_design() const { return result.evaluation.has_gradients(); }
};

/// Which limited values are good: those below an upper limit, or above a lower one.
enum class GoodSide { low, high };

/// Marks each point for which another one is better in one goal, by more than 1e-4 relative, and
/// not worse in the other. Points that break limits or have no design neither dominate nor are
/// dominated.
void mark_dominated(std::vector<ParetoPoint>& points, GoodSide side);

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
