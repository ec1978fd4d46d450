#include "studies/point_searches.hpp"

#include <utility>

#include "core/base/packed.hpp"
#include "core/base/parallel.hpp"
#include "core/base/stop.hpp"
#include "core/base/tasks.hpp"
#include "core/scene/packed_problem.hpp"
#include "optimization/design/design_problem.hpp"
#include "optimization/design/design_solve.hpp"
#include "optimization/design/size_choice.hpp"
#include "optimization/design/size_trials.hpp"
#include "optimization/result.hpp"
#include "optimization/solve.hpp"
#include "studies/front_ends.hpp"
#include "studies/sized_search.hpp"
#include "studies/varied_limit.hpp"

namespace pleuel {

namespace {

/// A point a task.
struct PointWork : TaskWork {
  ProblemFile problem;
  std::vector<PointSearch> searches;
  SolveOptions options;
  bool has_store = false;

  std::string run(int task, const std::string& needed, TaskCaller& caller) override {
    const PointSearch& search = searches[task];
    if (search.known) return packed(*search.known);
    RemoteStore store(caller);
    EvaluationStore* known = has_store ? &store : nullptr;
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

class PointSearches : public Tasks {
 public:
  PointSearches(const ProblemFile& problem, const std::vector<PointSearch>& searches,
                const SolveOptions& options, const Execution& execution,
                const ParetoObserver& observer)
      : execution_(execution), observer_(observer) {
    work_.problem = problem;
    work_.searches = searches;
    work_.options = options;
    work_.has_store = execution.store != nullptr;
  }

  int count() const override { return static_cast<int>(work_.searches.size()); }

  std::optional<int> needed_by(int task) const override { return work_.searches[task].from; }

  PackedWork packed_work() const override {
    return {point_work_name, packed(work_.problem, work_.searches, work_.options, work_.has_store)};
  }

  std::string run(int task, const std::string& needed, TaskCaller& caller) override {
    return work_.run(task, needed, caller);
  }

  std::string reply(int /*task*/, const std::string& question) override {
    return reply_of(*execution_.store, question);
  }

  void take(int /*task*/, const std::string& answer) override { add(unpacked<FoundPoint>(answer)); }

  void fail(int task, const std::string& failure) override {
    FoundPoint found;
    found.start = work_.start_of(work_.searches[task], "");
    found.point.limit = work_.searches[task].limit;
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

  PointWork work_;
  const Execution& execution_;
  const ParetoObserver& observer_;
  std::vector<FoundPoint> points_;
};

}  // namespace

void take_as_point(ParetoPoint& point, const ProblemFile& problem, EvaluationStore* store) {
  if (!point.has_design()) return;
  DesignProblem design(problem, available_threads(), store);
  Result& result = point.result;
  result.evaluation = design.evaluate(result.x, Request::values_and_gradients);
  result.constraint_multipliers = Eigen::VectorXd::Zero(result.evaluation.constraints.size());
  result.error.reset();  // of the response that it is best for
  point.limit = point.limited_value = limited_value(problem, result.evaluation.constraints);
}

std::unique_ptr<TaskWork> make_point_work(const std::string& content) {
  auto work = std::make_unique<PointWork>();
  unpack(content, work->problem, work->searches, work->options, work->has_store);
  return work;
}

FoundPoints search_points(const ProblemFile& problem, const std::vector<PointSearch>& searches,
                          const SolveOptions& options, const Execution& execution,
                          const ParetoObserver& observer) {
  PointSearches tasks(problem, searches, options, execution, observer);
  bool is_whole = true;
  try {
    run_tasks(tasks, execution.tasks);
  } catch (const Stopped&) {
    is_whole = false;
  }
  return {tasks.take_points(), is_whole};
}

}  // namespace pleuel
