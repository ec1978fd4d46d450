#include "studies/point_searches.hpp"

#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/base/stop.hpp"
#include "core/jobs/parallel.hpp"
#include "core/scene/packed_problem.hpp"
#include "optimization/design/design_problem.hpp"
#include "optimization/design/design_solve.hpp"
#include "optimization/design/size_choice.hpp"
#include "optimization/design/size_lists.hpp"
#include "optimization/evaluation_store.hpp"
#include "optimization/result.hpp"
#include "optimization/solve.hpp"
#include "studies/front_ends.hpp"
#include "studies/pareto_point.hpp"
#include "studies/sized_search.hpp"

namespace pleuel {

namespace {

/// A point a task.
struct PointData {
  static constexpr const char* kind = point_work_name;

  ProblemFile problem;
  std::vector<PointSearch> searches;
  SolveOptions options;

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

  FoundPoint point_from(const Eigen::VectorXd& start, const PointSearch& search,
                        EvaluationStore* known) const {
    if (search.objective_limit) return exchanged(start, search, known);
    FoundPoint found;
    found.start = start;
    ProblemFile varied = problem;
    set_limit(varied, search.limit);
    ParetoPoint& point = found.point;
    point.limit = search.limit;
    point.is_choice = has_choices(problem);
    if (search.keeps_sizes) {
      point.result = judged(varied, start, known);
    } else {
      start_from(start, varied.variables);
      SizedDesign best = search_with_sizes(varied, options, known);
      found.between = std::move(best.between);
      point.sizes = best.sizes;
      point.result = std::move(best.result);
    }
    if (!point.has_design()) return found;
    point.limited_value = limited_value(varied, point.result.evaluation.constraints);
    point.multiplier = multiplier_of_limit(varied, point.result.constraint_multipliers);
    return found;
  }

  /// With the limit on the objective.
  FoundPoint exchanged(const Eigen::VectorXd& start, const PointSearch& search,
                       EvaluationStore* known) const {
    FoundPoint found;
    found.start = start;
    found.point.limit = search.limit;
    found.point.objective_limit = search.objective_limit;
    ProblemFile file = with_exchanged_goals(problem, *search.objective_limit);
    start_from(start, file.variables);
    found.point.result = search_with_sizes(file, options, known).result;
    take_as_point(found.point, problem, known);
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

class PointSearches : public StoredTasks<PointData> {
 public:
  PointSearches(PointData data, EvaluationStore* store, const ParetoObserver& observer)
      : StoredTasks(std::move(data), store), observer_(observer) {}

  int count() const override { return int_size(data().searches); }

  std::optional<int> needed_by(int task) const override { return data().searches[task].from; }

  void take(int /*task*/, const std::string& answer) override { add(unpacked<FoundPoint>(answer)); }

  void fail(int task, const std::string& failure) override {
    FoundPoint found;
    found.start = data().start_of(data().searches[task], "");
    found.point.limit = data().searches[task].limit;
    found.point.result.message = "the search was lost: " + failure;
    found.point.result.x = found.start;
    add(std::move(found));
  }

  std::vector<FoundPoint> take_points() { return std::move(points_); }

 private:
  void add(FoundPoint found) {
    if (observer_) observer_(found.point);
    points_.push_back(std::move(found));
  }

  const ParetoObserver& observer_;
  std::vector<FoundPoint> points_;
};

}  // namespace

void take_as_point(ParetoPoint& point, const ProblemFile& problem, EvaluationStore* store) {
  if (!point.has_design()) return;
  DesignProblem design(problem, available_threads(), store);
  Result& result = point.result;
  result.evaluation = design.evaluate(result.x, Request::values_and_gradients);
  design.confirm([&](const Eigen::VectorXd& x) { return x == result.x; });
  result.constraint_multipliers = Eigen::VectorXd::Zero(result.evaluation.constraints.size());
  result.error.reset();  // of the response that it is best for
  point.limit = point.limited_value = limited_value(problem, result.evaluation.constraints);
}

std::unique_ptr<TaskWork> make_point_work(const std::string& content) {
  return make_stored_work<PointData>(content);
}

FoundPoints search_points(const ProblemFile& problem, const std::vector<PointSearch>& searches,
                          const SolveOptions& options, const Execution& execution,
                          const ParetoObserver& observer) {
  PointSearches tasks({problem, searches, options}, execution.store, observer);
  bool is_whole = true;
  try {
    run_tasks(tasks, execution.tasks);
  } catch (const Stopped&) {
    is_whole = false;
  }
  return {tasks.take_points(), is_whole};
}

}  // namespace pleuel
