#include "studies/choice_front.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/base/number_text.hpp"
#include "optimization/design/design_problem.hpp"
#include "optimization/design/size_choice.hpp"
#include "optimization/design/size_lists.hpp"
#include "optimization/design/size_trials.hpp"
#include "optimization/scaling.hpp"
#include "studies/front_scale.hpp"
#include "studies/varied_limit.hpp"

namespace pleuel {

namespace {

/// The problem with any value of what is limited.
ProblemFile without_limit(ProblemFile problem, GoodSide side) {
  set_limit(problem, side == GoodSide::low ? infinity : -infinity);
  return problem;
}

/// Scales of the constraints, from the first design that can be simulated.
std::optional<Eigen::VectorXd> scales_at(const ProblemFile& problem,
                                         const std::vector<Eigen::VectorXd>& designs,
                                         const Execution& execution) {
  DesignProblem design(problem, execution.tasks.jobs, execution.store);
  for (const Eigen::VectorXd& x : designs) {
    const Attempt attempt = attempt_evaluation(design, x, Request::values_and_gradients);
    if (!attempt.evaluation) continue;
    return constraint_scales(design, *attempt.evaluation, variable_scales(design, x));
  }
  return std::nullopt;
}

/// A choice that keeps all limits but the one that is varied.
struct TriedChoice {
  Eigen::VectorXd x;
  double objective = 0.0, limited = 0.0;  ///< [SI]
};

/// Those that are best for some limit from the tight to the loose end.
std::vector<TriedChoice> front_of(std::vector<TriedChoice> choices, const ParetoSettings& settings,
                                  GoodSide side) {
  const double sign = side == GoodSide::low ? 1.0 : -1.0;
  std::vector<Goals> goals;
  for (const TriedChoice& one : choices) goals.push_back({one.objective, sign * one.limited});
  const std::vector<bool> is_kept = non_dominated(goals);
  std::vector<TriedChoice> front;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (is_kept[i]) front.push_back(std::move(choices[i]));
  }
  std::stable_sort(front.begin(), front.end(),
                   [&](const TriedChoice& one, const TriedChoice& other) {
                     return sign * one.limited < sign * other.limited;
                   });
  if (!settings.goals.empty()) return front;
  const double tight = std::min(sign * settings.from, sign * settings.to);
  const double loose = std::max(sign * settings.from, sign * settings.to);
  std::erase_if(front,
                [&](const TriedChoice& one) { return !is_no_better(loose, sign * one.limited); });
  // The best at the tight end is the last within it; none within: the front begins further on.
  while (front.size() > 1 && is_no_better(tight, sign * front[1].limited)) {
    front.erase(front.begin());
  }
  return front;
}

/// All of them judged, each with its own value as its limit.
std::vector<PointSearch> judgements(const std::vector<TriedChoice>& front) {
  std::vector<PointSearch> searches;
  for (const TriedChoice& one : front) {
    PointSearch search;
    search.limit = one.limited;
    search.start = one.x;
    search.keeps_sizes = true;
    searches.push_back(std::move(search));
  }
  return searches;
}

}  // namespace

bool is_enumerable(const ProblemFile& problem) {
  return has_choices(problem) && !needs_optimization(problem) &&
         SizeLists(problem.variables).combinations() <= most_simulated_choices;
}

ParetoFront choice_front(const ProblemFile& problem, const SolveOptions& options,
                         const Execution& execution, const ParetoObserver& observer) {
  const GoodSide side = good_side(problem);
  const ProblemFile any = without_limit(problem, side);
  const SizeLists lists(problem.variables);
  std::vector<Eigen::VectorXd> designs;
  for (const Sizes& sizes : lists.all()) {
    designs.push_back(lists.design(sizes, start_design(problem)));
  }
  ParetoFront front;
  front.choices = ChoiceCounts{.all = int_size(designs)};
  const auto scales = scales_at(any, designs, execution);
  if (!scales) {
    front.choices->failed = front.choices->all;
    return front;
  }
  std::vector<TriedChoice> choices;
  for (const SizeTrial& trial : try_sizes(any, designs, *scales, options, execution)) {
    if (trial.has_failed()) ++front.choices->failed;
    if (!trial.keeps_limits()) continue;
    ++front.choices->feasible;
    choices.push_back({trial.x, trial.objective, limited_value(any, trial.constraints)});
  }
  const auto searches = judgements(front_of(std::move(choices), *problem.pareto, side));
  FoundPoints found = search_points(problem, searches, options, execution, observer);
  for (FoundPoint& one : found.points) front.points.push_back(std::move(one.point));
  front.is_whole = found.is_whole;
  return front;
}

}  // namespace pleuel
