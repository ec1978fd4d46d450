#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/problem_file.hpp"
#include "optimization/evaluation_store.hpp"
#include "optimization/prices.hpp"
#include "optimization/solve.hpp"

namespace pleuel {

/// The best design for one value of the limit that is varied.
struct ParetoPoint {
  double limit = 0.0;  ///< [SI]
  /// Of the constraint whose limit is varied [SI]; of several load cases the worst.
  double limited_value = 0.0;
  /// Of that constraint: d(objective)/d(limit) = −multiplier. Only where has_prices(result).
  double multiplier = 0.0;
  bool is_dominated = false;  ///< another point is better in one goal and no worse in the other
  bool is_end = false;        ///< the best design for one of two responses; it has no multiplier
  Result result;

  bool has_design() const { return result.evaluation.has_gradients(); }
  /// Whether its search came to a design within the limits.
  bool keeps_limits() const;
  bool has_multiplier() const { return !is_end && has_prices(result); }
};

/// Which limited values are good: those below an upper limit, or above a lower one.
enum class GoodSide { low, high };

/// Marks each point for which another one is better in one goal, by more than 1e-4 relative, and
/// not worse in the other. Points that break limits or have no design neither dominate nor are
/// dominated.
void mark_dominated(std::vector<ParetoPoint>& points, GoodSide side);

/// Sees each point as it is found; dominance is known only at the end.
using ParetoObserver = std::function<void(const ParetoPoint&)>;

/// The order in which points are found, and the one that each begins at: ends first, then the middle
/// of each gap from the nearer end of it.
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
/// (core/base/tasks.hpp); the points do not depend on the number of jobs. Every point is audited
/// like any optimum. Between two responses the ends are found first: the best design for each of
/// them, and of equally good ones (to 10⁻⁴ of their value) the best for the other; the limit on the second
/// goes from one to the other. Where both ends are the same there is one point: nothing is to be traded.
/// @param problem  of two responses: that of trade_off_problem()
/// @returns the points that were found before a stop, if one was asked for, in the order of limits
/// @throws Stopped before the first
/// @throws InputError if the problem has no pareto settings, variables or objective
std::vector<ParetoPoint> pareto_front(const ProblemFile& problem, const SolveOptions& options,
                                      const Execution& execution = {},
                                      const ParetoObserver& observer = {});

/// The searches for points, made again on another rank (PackedWork).
inline constexpr const char* point_work_name = "points";
std::unique_ptr<TaskWork> make_point_work(const std::string& content);

}  // namespace pleuel
