#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/problem_file.hpp"
#include "optimization/evaluation_store.hpp"
#include "optimization/solve.hpp"
#include "studies/sized_search.hpp"

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

// The ends of a front between two responses.

/// The best design for one of two responses.
struct FrontEnd {
  Result result;
  std::array<double, 2> values{};  ///< of both responses
  std::optional<TriedSizes> sizes = {};
  double start_value = 0.0;  ///< of the response that it is best for, where the search began
};

/// One of the responses between both ends. Where it is 0 at both, round-off of what it was at the
/// start is its accuracy.
GoalScale end_scale(const std::vector<FrontEnd>& ends, std::size_t goal);

/// The best designs for both responses (ParetoSettings::goals), and of equally good ones the best for
/// the other. Each search is a task of its own.
/// @param file  that of the user: without the limit that is varied
/// @returns two, whatever became of their searches
std::vector<FrontEnd> find_front_ends(const ProblemFile& file, const SolveOptions& options,
                                      const Execution& execution);

/// Sets starts, within the bounds exactly: an optimum may miss them by rounding.
void start_from(const Eigen::VectorXd& x, std::vector<DesignVariable>& variables);

/// The searches, made again on another rank (PackedWork).
inline constexpr const char* end_work_name = "ends";
std::unique_ptr<TaskWork> make_end_work(const std::string& content);

}  // namespace pleuel
