#include "studies/pareto.hpp"

#include <algorithm>
#include <iterator>
#include <map>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/find_named.hpp"
#include "core/base/stop.hpp"
#include "core/scene/case_goals.hpp"
#include "optimization/design/design_problem.hpp"
#include "optimization/design/size_choice.hpp"
#include "optimization/design/size_lists.hpp"
#include "optimization/scaling.hpp"
#include "studies/missing_settings.hpp"

namespace pleuel {

ParetoOrder pareto_order(int points) {
  ParetoOrder order;
  std::map<int, int> places;  // of the points that are in the order
  const auto add = [&](int point, std::optional<int> from) {
    places[point] = int_size(order.points);
    order.points.push_back(point);
    order.from.push_back(from);
  };
  if (points > 0) add(0, std::nullopt);
  if (points > 1) add(points - 1, std::nullopt);
  while (int_size(order.points) < points) {
    const std::map<int, int> before = places;
    for (auto low = before.begin(), high = std::next(low); high != before.end(); low = high++) {
      const int middle = (low->first + high->first) / 2;
      if (middle == low->first) continue;
      const int below = middle - low->first, above = high->first - middle;
      // Of two as near, the one that is known first.
      const bool takes_low = below < above || (below == above && low->second < high->second);
      add(middle, takes_low ? low->second : high->second);
    }
  }
  return order;
}

namespace {

/// Of the worst case it stands in all of them, and bears the name that the response has there.
std::string name_of_limit_on(const Objective& goal, const ProblemFile& problem) {
  if (goal.over_cases != OverCases::worst) return goal.response;
  const auto index = index_of_named(problem.responses, goal.response);
  if (!index) return goal.response;
  return problem.cases.front().responses[problem.case_responses[*index].index].name;
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

/// Whether there is nothing to design but sizes from lists, with at most 300 choices of them.
bool is_enumerable(const ProblemFile& problem) {
  return has_choices(problem) && !needs_optimization(problem) &&
         SizeLists(problem.variables).combinations() <= most_simulated_choices;
}

/// The front as it grows.
struct Front {
  const ProblemFile& problem;
  const SolveOptions& options;
  const Execution& execution;
  const ParetoObserver& observer;
  const ParetoSettings& settings = *problem.pareto;
  const GoodSide side = good_side(problem);
  std::vector<FoundPoint> known = {};  ///< by limit

  /// @param ends  that are known, or none
  ParetoFront run(std::vector<FoundPoint> ends) {
    bool is_whole = search(first_searches(std::move(ends)));
    ParetoFront front;
    while (is_whole && settings.gap > 0.0) {
      const int room = settings.most_points - int_size(known);
      front.gaps = find_front_gaps(
          points(), side, settings.gap, std::max(room, 0),
          can_exchange_goals(problem) ? ObjectiveLimits::possible : ObjectiveLimits::impossible);
      if (front.gaps.probes.empty()) break;
      is_whole = search(next_searches(front.gaps.probes));
    }
    front.points = points();
    front.is_whole = is_whole;
    return front;
  }

  /// Simulates every choice of sizes. The front is all of them that keep the limits and that no other
  /// dominates, to round-off: that of the problem itself, not of searches. Of a limit that goes from
  /// one value to another it is what is best at some limit between. Each point is judged like any
  /// optimum, with its own value as its limit.
  ParetoFront of_choices() const {
    ProblemFile any = problem;  // with any value of what is limited
    set_limit(any, sign() * infinity);
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
    std::vector<PointSearch> choices;
    std::vector<Goals> goals;
    for (const SizeTrial& trial : try_sizes(any, designs, *scales, options, execution)) {
      if (trial.has_failed()) ++front.choices->failed;
      if (!trial.keeps_limits()) continue;
      ++front.choices->feasible;
      const double limited = limited_value(any, trial.constraints);
      choices.push_back({.limit = limited, .start = trial.x, .keeps_sizes = true});
      goals.push_back({trial.objective, sign() * limited});
    }
    FoundPoints found =
        search_points(problem, best_of(choices, goals), options, execution, observer);
    for (FoundPoint& one : found.points) front.points.push_back(std::move(one.point));
    front.is_whole = found.is_whole;
    return front;
  }

 private:
  /// At equal steps of the limit.
  std::vector<PointSearch> first_searches(std::vector<FoundPoint> ends) const {
    const ParetoOrder order = pareto_order(settings.points);
    std::vector<PointSearch> searches;
    for (std::size_t i = 0; i < order.points.size(); ++i) {
      const double share = static_cast<double>(order.points[i]) / std::max(settings.points - 1, 1);
      searches.push_back({std::lerp(settings.from, settings.to, share), order.from[i]});
      if (i < ends.size()) searches[i].known = std::move(ends[i]);
    }
    return searches;
  }

  std::vector<PointSearch> next_searches(const std::vector<FrontProbe>& probes) const {
    std::vector<PointSearch> searches;
    for (const FrontProbe& probe : probes) {
      PointSearch search{probe.limit, std::nullopt, known[probe.from].next_start()};
      if (probe.other != probe.from) search.other = known[probe.other].next_start();
      if (probe.objective_limit) {
        search.objective_limit = probe.objective_limit;
        search.other_problem = with_exchanged_goals(problem, *probe.objective_limit);
      }
      searches.push_back(std::move(search));
    }
    return searches;
  }

  /// Keeps the order of limits.
  /// @returns whether no stop was asked for
  bool search(const std::vector<PointSearch>& searches) {
    FoundPoints news = search_points(problem, searches, options, execution, observer);
    for (FoundPoint& one : news.points) known.push_back(std::move(one));
    const bool is_falling = settings.to < settings.from;
    std::ranges::stable_sort(known, [&](const FoundPoint& a, const FoundPoint& b) {
      return is_falling ? a.point.limit > b.point.limit : a.point.limit < b.point.limit;
    });
    if (known.empty()) throw Stopped();
    return news.is_whole;
  }

  std::vector<ParetoPoint> points() const {
    std::vector<ParetoPoint> points;
    for (const FoundPoint& one : known) points.push_back(one.point);
    mark_dominated(points, side);
    return points;
  }

  /// Of searches for choices with these goals, those that are best for some limit from the tight to the
  /// loose end.
  std::vector<PointSearch> best_of(const std::vector<PointSearch>& choices,
                                   const std::vector<Goals>& goals) const {
    const std::vector<bool> is_kept = non_dominated(goals);
    const auto signed_limit = [&](const PointSearch& one) { return sign() * one.limit; };
    std::vector<PointSearch> front;
    for (std::size_t i = 0; i < choices.size(); ++i) {
      if (is_kept[i]) front.push_back(choices[i]);
    }
    std::ranges::stable_sort(front, {}, signed_limit);
    if (!settings.goals.empty()) return front;
    const auto ends = std::minmax({sign() * settings.from, sign() * settings.to});
    const double tight = ends.first, loose = ends.second;
    std::erase_if(front,
                  [&](const PointSearch& one) { return !is_no_better(loose, signed_limit(one)); });
    // The best at the tight end is the last within it; none within: the front begins further on.
    while (front.size() > 1 && is_no_better(tight, signed_limit(front[1]))) {
      front.erase(front.begin());
    }
    return front;
  }

  double sign() const { return side == GoodSide::low ? 1.0 : -1.0; }
};

/// What there is where an end was not found, or nothing is to be traded and one end is left.
ParetoFront front_of_ends(std::vector<FoundPoint> ends, const ParetoObserver& observer) {
  ParetoFront front;
  for (FoundPoint& end : ends) {
    if (observer) observer(end.point);
    front.points.push_back(std::move(end.point));
  }
  return front;
}

/// Between two responses; one point if there is nothing to trade.
ParetoFront front_between(ProblemFile problem, const SolveOptions& options,
                          const Execution& execution, const ParetoObserver& observer) {
  auto [ends, scales] = find_front_ends(problem, options, execution);
  ParetoSettings& settings = *problem.pareto;
  settings.from = ends[0].point.limit;
  settings.to = ends[1].point.limit;
  const bool has_ends = ends[0].point.has_design() && ends[1].point.has_design();
  if (!has_ends) return front_of_ends(std::move(ends), observer);
  const bool trades_limited = scales[1].is_traded();
  if (!trades_limited || !scales[0].is_traded()) {
    // The end that is better in what the other one is as good as.
    ends.erase(ends.begin() + (trades_limited ? 0 : 1));
    return front_of_ends(std::move(ends), observer);
  }
  return Front{problem, options, execution, observer}.run(std::move(ends));
}

}  // namespace

ProblemFile trade_off_problem(ProblemFile problem) {
  if (!problem.pareto || problem.pareto->goals.empty()) return problem;
  for (Objective& goal : problem.pareto->goals) goal = goal_of_problem(problem, goal);
  const Objective &first = problem.pareto->goals[0], &second = problem.pareto->goals[1];
  std::string name = name_of_limit_on(second, problem);
  while (!constraints_of_limit(problem, name).empty()) name += " (traded)";
  set_objective(problem, first);
  add_limit(problem, second, second.sign() * infinity, name);
  problem.pareto->constraint = name;
  return problem;
}

ParetoFront pareto_front(const ProblemFile& problem, const SolveOptions& options,
                         const Execution& execution, const ParetoObserver& observer) {
  require_pareto(problem);
  DesignProblem{problem};  // says what is missing
  if (is_enumerable(problem)) return Front{problem, options, execution, observer}.of_choices();
  if (has_choices(problem) && problem.pareto->gap > 0.0) {
    throw InputError(
        "/pareto/gap: a front of sizes from lists has only the points that \"points\" asks for, "
        "unless "
        "all choices can be simulated (at most 300 of them, and no other variables)");
  }
  if (!problem.pareto->goals.empty()) return front_between(problem, options, execution, observer);
  return Front{problem, options, execution, observer}.run({});
}

}  // namespace pleuel
