#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/scene/problem_file.hpp"
#include "optimization/result.hpp"
#include "studies/front_ends.hpp"
#include "studies/sized_search.hpp"

namespace pleuel {

/// The best design for one value of the limit that is varied.
struct ParetoPoint {
  double limit = 0.0;  ///< [SI]
  /// Of the constraint whose limit is varied [SI]; of several load cases the worst.
  double limited_value = 0.0;
  /// Of that constraint: d(objective)/d(limit) = −multiplier. Only where has_prices(result).
  double multiplier = 0.0;
  /// It was found with this limit on the objective, in place of one on what is limited [SI; of what
  /// is maximized the negative]; it has no multiplier.
  std::optional<double> objective_limit;
  bool is_dominated = false;  ///< another point is better in one goal and no worse in the other
  bool is_end = false;        ///< the best design for one of two responses; it has no multiplier
  bool is_choice = false;     ///< sizes of it come from lists: it has no multiplier either
  std::optional<TriedSizes> sizes;  ///< how they were chosen for it alone
  Result result;

  bool has_design() const { return result.evaluation.has_gradients(); }
  /// Whether its search came to a design within the limits.
  bool keeps_limits() const;
  bool has_multiplier() const {
    return !is_end && !is_choice && !objective_limit && has_prices(result);
  }
};

/// Which limited values are good: those below an upper limit, or above a lower one.
enum class GoodSide { low, high };

Goals goals_of(const ParetoPoint& point, GoodSide side);

/// Marks each point for which another one is better in one goal and not worse in the other
/// (FrontScale). Points that break limits or have no design neither dominate nor are dominated.
void mark_dominated(std::vector<ParetoPoint>& points, GoodSide side);

/// The knee of a front: the point that is furthest from the straight line between the ends, towards
/// what is good in both goals, each divided by its range (Das 1999, Structural Optimization 18,
/// 107–115). With the ends at (0, 1) and (1, 0) that is the largest (1 − u − v)/√2. On either side of
/// it a little more of one goal costs more and more of the other.
///
/// Counted are points within their limits that no other dominates.
/// @param points  in the order of limits, marked by mark_dominated()
/// @returns the index of the point; none where less than three count, or where all are within 5 % of
///          the line: such a front is traded at one price
std::optional<std::size_t> find_knee(const std::vector<ParetoPoint>& points, GoodSide side);

// The limit that a front varies (ParetoSettings::constraint).

/// Of a limit that holds in several load cases all its constraints, else one.
/// @throws InputError if there is none
std::vector<std::size_t> varied_rows(const ProblemFile& problem);

/// Which of its values are good.
GoodSide good_side(const ProblemFile& problem);

/// @param limit  [SI]
void set_limit(ProblemFile& problem, double limit);

/// The value that is the nearest to the limit, or the furthest beyond [SI].
double limited_value(const ProblemFile& problem, const Eigen::VectorXd& constraints);

/// Of all constraints of the limit together, which moves in all of them.
double multiplier_of_limit(const ProblemFile& problem, const Eigen::VectorXd& multipliers);

/// Whether the goals can be exchanged: between two responses, or of one problem without load cases
/// whose limit is on a response, not on a sum of variables, and is kept free of no deviations.
bool can_exchange_goals(const ProblemFile& problem);

/// The problem that improves what is limited, with a limit on the objective.
/// @param objective_limit  [SI], of what is maximized the negative
ProblemFile with_exchanged_goals(ProblemFile problem, double objective_limit);

}  // namespace pleuel
