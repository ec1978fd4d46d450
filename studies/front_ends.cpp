#include "studies/front_ends.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/base/stop.hpp"
#include "core/scene/case_goals.hpp"

namespace pleuel {

namespace {

/// By how much goals may be missed where the other one is improved, relative to their value.
constexpr double end_tolerance = 1e-4;

/// The file with another objective, and at most this value (of what is maximized at least) of
/// another response.
ProblemFile with_goal(ProblemFile file, const Objective& goal,
                      const std::optional<std::pair<Objective, double>>& limit) {
  set_objective(file, goal);
  if (limit) add_limit(file, limit->first, limit->second, limit->first.response);
  return file;
}

/// What the best of a response may lose for the good of the other one: a share of its value, which may
/// be much smaller than the front is long, but no less than round-off of the front. Of a response
/// that is the same at both ends all that cannot be told apart.
double end_slack(double value, const GoalScale& scale) {
  if (!scale.is_traded()) return scale.accuracy;
  return end_tolerance * std::clamp(std::abs(value), 1e-4 * scale.range(), scale.range());
}

class EndSearch {
 public:
  EndSearch(const ProblemFile& problem, const SolveOptions& options, const Execution& execution)
      : problem_(problem), file_(problem), options_(options), execution_(execution) {
    remove_limit(file_, problem.pareto->constraint);
  }

  FrontEnds run() {
    const Eigen::VectorXd start = start_design(file_);
    FrontEnds ends{searched({goal(0), std::nullopt, start}, {goal(1), std::nullopt, start}), {}};
    for (std::size_t i = 0; i < 2; ++i) {
      const History& history = ends.points[i].point.result.history;
      start_values_[i] = history.empty() ? 0.0 : first_design(history).objective;
    }
    measure(ends);
    const bool are_found = keeps_limits(ends.points[0]) && keeps_limits(ends.points[1]);
    if (are_found && (ends.scales[0].is_traded() || ends.scales[1].is_traded())) refine(ends);
    for (FoundPoint& end : ends.points) {
      end.start = end.point.result.x;
      end.point.is_end = true;
    }
    return ends;
  }

 private:
  struct Goal {
    const Objective& best;
    std::optional<std::pair<Objective, double>> limit;
    Eigen::VectorXd start;
  };

  const Objective& goal(std::size_t i) const { return problem_.pareto->goals[i]; }

  std::vector<FoundPoint> searched(const Goal& first, const Goal& second) const {
    std::vector<PointSearch> searches;
    for (const Goal* one : {&first, &second}) {
      PointSearch search{.start = one->start};
      search.other_problem = with_goal(file_, one->best, one->limit);
      searches.push_back(std::move(search));
    }
    FoundPoints found = search_points(problem_, searches, options_, execution_);
    if (!found.is_whole) throw Stopped();
    return std::move(found.points);
  }

  static bool keeps_limits(const FoundPoint& end) {
    return end.point.has_design() && end.point.result.max_violation <= Tolerances().violation;
  }

  double value(const FoundPoint& end, std::size_t i) const {
    return i == 0 ? goal(0).sign() * end.point.result.evaluation.objective
                  : end.point.limited_value;
  }

  /// Where a response is 0 at both ends, round-off of what it was at the start is its accuracy.
  void measure(FrontEnds& ends) const {
    for (std::size_t i = 0; i < 2; ++i) {
      const auto [low, high] = std::minmax({value(ends.points[0], i), value(ends.points[1], i)});
      ends.scales[i] = {
          low, high,
          std::max({optimum_accuracy * std::abs(low), optimum_accuracy * std::abs(high),
                    equal_numbers * std::abs(start_values_[i])})};
    }
  }

  /// Takes designs whose other response is better, where there are some that are as good.
  void refine(FrontEnds& ends) const {
    const auto as_good_as = [&](std::size_t i) {
      const double best = value(ends.points[i], i);
      const double limit = best + goal(i).sign() * end_slack(best, ends.scales[i]);
      return Goal{goal(1 - i), std::pair(goal(i), limit), ends.points[i].point.result.x};
    };
    std::vector<FoundPoint> refined = searched(as_good_as(0), as_good_as(1));
    for (std::size_t i = 0; i < 2; ++i) {
      const std::size_t other = 1 - i;
      const GoalScale& scale = ends.scales[other];
      const double gain =
          goal(other).sign() * (value(ends.points[i], other) - value(refined[i], other));
      const bool is_better =
          gain > (scale.is_traded() ? 10.0 * end_tolerance * scale.range() : scale.accuracy);
      if (keeps_limits(refined[i]) && is_better) ends.points[i] = std::move(refined[i]);
    }
    measure(ends);
  }

  const ProblemFile& problem_;
  ProblemFile file_;  ///< that of the user: without the limit that is varied
  const SolveOptions& options_;
  const Execution& execution_;
  std::array<double, 2> start_values_{};
};

}  // namespace

FrontEnds find_front_ends(const ProblemFile& problem, const SolveOptions& options,
                          const Execution& execution) {
  return EndSearch(problem, options, execution).run();
}

}  // namespace pleuel
