#pragma once

#include "core/scene/problem_file.hpp"
#include "optimization/result.hpp"

/// What is equal and what is better in the two goals of a front: the one measure for its ends, for
/// dominance, gaps and the knee.
///
/// Values are those of designs, and so they are compared to round-off: a design is no worse than
/// another one if it is so to 10⁻⁹ of the values. But designs are found by searches, which end
/// within about 10⁻⁶ of their optimum (the default of OptimizerSettings::tolerance). So a design
/// is better only by more than this, and by more than 10⁻⁴ of what the goal covers on the front.
/// The size of a goal beside its range plays no part as long as its range is more than that.
namespace pleuel {

/// Accuracy of verified optima, relative to the value.
inline constexpr double optimum_accuracy = 1e-6;
/// Numbers that differ by less are equal, relative.
inline constexpr double equal_numbers = 1e-9;

/// Both goals of a design, small is good: the objective, and what is limited.
using Goals = std::array<double, 2>;

/// One goal of a front [SI].
struct GoalScale {
  double low = 0.0, high = 0.0;  ///< on the front
  double accuracy = 0.0;         ///< of optima

  double range() const { return high - low; }
  /// Whether there is more between its ends than the accuracy of optima.
  bool is_traded() const { return range() > accuracy; }
  /// 1 / range; 0 where it is not traded: it plays no part in distances then.
  double per_range() const { return is_traded() ? 1.0 / range() : 0.0; }
  /// What counts as better.
  double least_gain() const;
  /// What does not count as worse, between two values.
  double round_off(double one, double other) const;
};

/// Whether designs of a front were found with the same limit: then that is kept alike by both.
enum class Limits { same, different };

class FrontScale {
 public:
  /// @param designs  within their limits; those that others dominate by more than round-off do not
  ///                 count
  explicit FrontScale(const std::vector<Goals>& designs);

  const GoalScale& objective() const { return goals_[0]; }
  const GoalScale& limited() const { return goals_[1]; }
  bool is_traded() const { return goals_[0].is_traded() && goals_[1].is_traded(); }

  /// Whether one is better in a goal by least_gain(), and not worse in the other: by more than
  /// round-off, or, where both were found with the same limit, in what is limited by as much as
  /// searches keep it.
  bool dominates(const Goals& one, const Goals& other, Limits limits) const;

 private:
  std::array<GoalScale, 2> goals_;
};

/// No smaller by more than round-off.
bool is_no_better(double one, double other);

/// Of designs with two numbers each, both good where they are small, those that no other dominates:
/// better in one by more than round-off, and no worse in the other.
std::vector<bool> non_dominated(const std::vector<Goals>& goals);

/// How sizes were chosen from lists.
struct TriedSizes {
  double combinations = 1.0;
  int tried = 0;
  bool is_exhaustive = false;  ///< all were: the design is the best of them
  /// By how much the objective may be above that of the best choice: relative to the optimum between
  /// the sizes, which no choice can beat if it is the global one.
  double penalty = 0.0;
};

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
