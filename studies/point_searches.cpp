#include "studies/point_searches.hpp"

#include <algorithm>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/base/stop.hpp"
#include "core/jobs/parallel.hpp"
#include "core/scene/case_goals.hpp"
#include "core/scene/packed_problem.hpp"
#include "optimization/design/design_solve.hpp"
#include "optimization/design/size_choice.hpp"
#include "optimization/design/size_lists.hpp"

namespace pleuel {

namespace {

/// See PointSearch::other_problem.
void take_as_point(ParetoPoint& point, const ProblemFile& problem, EvaluationStore* store) {
  DesignProblem design(problem, available_threads(), store);
  Result& result = point.result;
  result.evaluation = design.evaluate(result.x, Request::values_and_gradients);
  design.confirm([&](const Eigen::VectorXd& x) { return x == result.x; });
  result.constraint_multipliers = Eigen::VectorXd::Zero(result.evaluation.constraints.size());
  result.error.reset();  // of the response that it is best for
  point.limit = point.limited_value = limited_value(problem, result.evaluation.constraints);
}

/// A point a task.
struct PointData {
  static constexpr const char* kind = point_work_name;
  using Answer = FoundPoint;

  ProblemFile problem;
  std::vector<PointSearch> searches;
  SolveOptions options;

  int count() const { return int_size(searches); }

  std::optional<int> needed_by(int task) const { return searches[task].from; }

  FoundPoint lost(int task, const std::string& failure) const {
    FoundPoint found;
    found.start = found.point.result.x = start_of(searches[task], "");
    found.point.limit = searches[task].limit;
    found.point.result.message = "the search was lost: " + failure;
    return found;
  }

  std::string run(int task, const std::string& needed, TaskCaller& /*caller*/,
                  EvaluationStore* known) const {
    const PointSearch& search = searches[task];
    if (search.known) return packed(*search.known);
    FoundPoint found = point_from(start_of(search, needed), search, known);
    if (search.other && !found.point.keeps_limits()) {
      FoundPoint second = point_from(*search.other, search, known);
      continue_from(found.point.result, second.point.result);
      if (second.point.keeps_limits()) {
        found = std::move(second);
      } else {
        found.point.result = with_effort_of(std::move(second.point.result), found.point.result);
      }
    }
    return packed(found);
  }

 private:
  FoundPoint point_from(const Eigen::VectorXd& start, const PointSearch& search,
                        EvaluationStore* known) const {
    FoundPoint found;
    found.start = start;
    ParetoPoint& point = found.point;
    point.limit = search.limit;
    point.objective_limit = search.objective_limit;
    point.is_choice = has_choices(problem);
    ProblemFile file = search.other_problem.value_or(problem);
    if (!search.other_problem) set_limit(file, search.limit);
    if (search.keeps_sizes) {
      point.result = judged(file, start, known);
    } else {
      start_from(start, file.variables);
      SizedDesign best = search_with_sizes(file, options, known);
      if (!search.other_problem) found.between = std::move(best.between);
      point.sizes = best.sizes;
      point.result = std::move(best.result);
    }
    if (!point.has_design()) return found;
    if (search.other_problem) {
      take_as_point(point, problem, known);
    } else {
      point.limited_value = limited_value(file, point.result.evaluation.constraints);
      point.multiplier = multiplier_of_limit(file, point.result.constraint_multipliers);
    }
    return found;
  }

  Result judged(const ProblemFile& varied, const Eigen::VectorXd& x, EvaluationStore* known) const {
    DesignProblem design(with_sizes(varied, x), available_threads(), known);
    design.start_from(x);
    return judge_design(design, options);
  }

  /// @param needed  the point that it begins at; empty if that was lost
  Eigen::VectorXd start_of(const PointSearch& search, const std::string& needed) const {
    if (search.start) return *search.start;
    return needed.empty() ? start_design(problem) : unpacked<FoundPoint>(needed).next_start();
  }
};

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

struct EndSearch {
  const ProblemFile& problem;
  const SolveOptions& options;
  const Execution& execution;
  ProblemFile file = problem;  ///< without the limit that is varied
  std::array<double, 2> start_values = {};

  FrontEnds run() {
    remove_limit(file, problem.pareto->constraint);
    const Eigen::VectorXd start = start_design(file);
    FrontEnds ends{searched({goal(0), std::nullopt, start}, {goal(1), std::nullopt, start}), {}};
    for (std::size_t i = 0; i < 2; ++i) {
      const History& history = ends.points[i].point.result.history;
      start_values[i] = history.empty() ? 0.0 : first_design(history).objective;
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

  const Objective& goal(std::size_t i) const { return problem.pareto->goals[i]; }

  std::vector<FoundPoint> searched(const Goal& first, const Goal& second) const {
    std::vector<PointSearch> searches;
    for (const Goal* one : {&first, &second}) {
      PointSearch search{.start = one->start};
      search.other_problem = with_goal(file, one->best, one->limit);
      searches.push_back(std::move(search));
    }
    FoundPoints found = search_points(problem, searches, options, execution);
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
                    equal_numbers * std::abs(start_values[i])})};
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
};

}  // namespace

SizedDesign search_with_sizes(const ProblemFile& file, const SolveOptions& options,
                              EvaluationStore* store) {
  StagedSolution solution;
  solution.problem = std::make_unique<DesignProblem>(file, available_threads(), store);
  solution.result = solve_design(*solution.problem, options);
  if (!has_choices(file)) return {std::move(solution.result), std::move(solution.problem), {}, {}};
  const SizeChoiceReport report =
      choose_sizes(solution, {options, {{.jobs = available_threads()}, store}});
  if (!report.is_choice && solution.result.evaluation.has_gradients()) {
    solution.result.status = Status::failed;
    solution.result.message = "no choice of sizes could be simulated";
    solution.result.evaluation = {};
  }
  const TriedSizes sizes = {report.combinations, report.tried, report.is_exhaustive,
                            report.penalty(solution.result.evaluation.objective)};
  return {std::move(solution.result), std::move(solution.problem), report.relaxed_x, sizes};
}

void start_from(const Eigen::VectorXd& x, std::vector<DesignVariable>& variables) {
  for (std::size_t i = 0; i < variables.size(); ++i) {
    variables[i].start = std::clamp(x(i), variables[i].lower, variables[i].upper);
  }
}

std::unique_ptr<TaskWork> make_point_work(const std::string& content) {
  return make_stored_work<PointData>(content);
}

FoundPoints search_points(const ProblemFile& problem, const std::vector<PointSearch>& searches,
                          const SolveOptions& options, const Execution& execution,
                          const ParetoObserver& observer) {
  AnsweredTasks<PointData> tasks({problem, searches, options}, execution.store,
                                 [&](const FoundPoint& found) {
                                   if (observer) observer(found.point);
                                 });
  bool is_whole = true;
  try {
    run_tasks(tasks, execution.tasks);
  } catch (const Stopped&) {
    is_whole = false;
  }
  return {tasks.take_answers(), is_whole};
}

FrontEnds find_front_ends(const ProblemFile& problem, const SolveOptions& options,
                          const Execution& execution) {
  return EndSearch{problem, options, execution}.run();
}

}  // namespace pleuel
