#include "studies/pareto.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/parallel.hpp"
#include "core/base/stop.hpp"
#include "core/base/tasks.hpp"
#include "core/scene/case_goals.hpp"
#include "core/scene/packed_problem.hpp"
#include "optimization/design/design_problem.hpp"
#include "optimization/design/design_solve.hpp"
#include "optimization/packed_options.hpp"
#include "optimization/packed_result.hpp"
#include "studies/front_ends.hpp"

namespace pleuel {

namespace {

/// Of a limit that holds in several load cases all its constraints, else one.
std::vector<std::size_t> varied_rows(const ProblemFile& problem) {
  std::vector<std::size_t> rows = constraints_of_limit(problem, problem.pareto->constraint);
  if (rows.empty()) throw InputError("/pareto/constraint names no constraint");
  return rows;
}

void set_limit(ProblemFile& problem, double limit) {
  for (const std::size_t row : varied_rows(problem)) {
    ConstraintSettings& constraint = problem.constraints[row];
    (constraint.upper ? constraint.upper : constraint.lower) = limit;
  }
}

/// The value that is the nearest to the limit, or the furthest beyond.
double limited_value(const ProblemFile& problem, const Eigen::VectorXd& constraints) {
  std::optional<double> worst;
  for (const std::size_t row : varied_rows(problem)) {
    const double value = constraints(static_cast<Eigen::Index>(row));
    const bool is_upper = problem.constraints[row].upper.has_value();
    if (!worst || (is_upper ? value > *worst : value < *worst)) worst = value;
  }
  return *worst;
}

/// Of all constraints of the limit together, which moves in all of them.
double multiplier_of_limit(const ProblemFile& problem, const Eigen::VectorXd& multipliers) {
  double sum = 0.0;
  for (const std::size_t row : varied_rows(problem)) {
    sum += multipliers(static_cast<Eigen::Index>(row));
  }
  return sum;
}

bool dominates(const ParetoPoint& one, const ParetoPoint& other, GoodSide side) {
  const double sign = side == GoodSide::low ? 1.0 : -1.0;
  const double gain = other.result.evaluation.objective - one.result.evaluation.objective;
  const double limited_gain = sign * (other.limited_value - one.limited_value);
  const double least = optimum_resolution * std::abs(one.result.evaluation.objective);
  const double least_limited = optimum_resolution * std::abs(one.limited_value);
  return gain >= -least && limited_gain >= -least_limited &&
         (gain > least || limited_gain > least_limited);
}

/// A point as an answer of a task, with the design that its search began at.
struct FoundPoint {
  Eigen::VectorXd start;
  ParetoPoint point;

  /// Where the search for a neighbour begins.
  const Eigen::VectorXd& next_start() const {
    return point.keeps_limits() ? point.result.x : start;
  }
};

template <class Archive>
void transfer(Archive& archive, FoundPoint& found) {
  auto& [start, point] = found;
  auto& [limit, limited_value, multiplier, is_dominated, is_end, result] = point;
  archive(start, limit, limited_value, multiplier, is_dominated, is_end, result);
}

/// A point a task.
struct PointWork : TaskWork {
  ProblemFile problem;
  std::vector<FoundPoint> ends;  ///< that are known, or none
  std::vector<double> limits;    ///< in the order of tasks
  SolveOptions options;
  bool has_store = false;

  std::string run(int task, const std::string& needed, TaskCaller& caller) override {
    if (static_cast<std::size_t>(task) < ends.size()) return packed(ends[task]);
    RemoteStore store(caller);
    FoundPoint found;
    found.start =
        needed.empty() ? start_design(problem) : unpacked<FoundPoint>(needed).next_start();
    ProblemFile varied = problem;
    set_limit(varied, limits[task]);
    start_from(found.start, varied.variables);
    DesignProblem design(varied, available_threads(), has_store ? &store : nullptr);
    found.point.limit = limits[task];
    found.point.result = solve_design(design, options);
    if (found.point.has_design()) {
      const Result& result = found.point.result;
      found.point.limited_value = limited_value(varied, result.evaluation.constraints);
      found.point.multiplier = multiplier_of_limit(varied, result.constraint_multipliers);
    }
    return packed(found);
  }
};

class Front : public Tasks {
 public:
  /// @param ends  that are known, or none
  Front(const ProblemFile& problem, std::vector<FoundPoint> ends, const SolveOptions& options,
        const Execution& execution, const ParetoObserver& observer)
      : execution_(execution),
        observer_(observer),
        order_(pareto_order(problem.pareto->points)),
        points_(order_.points.size()) {
    work_.problem = problem;
    work_.ends = std::move(ends);
    for (int task = 0; task < count(); ++task) work_.limits.push_back(limit(task));
    work_.options = options;
    work_.has_store = execution.store != nullptr;
  }

  int count() const override { return static_cast<int>(order_.points.size()); }

  std::optional<int> needed_by(int task) const override { return order_.from[task]; }

  PackedWork packed_work() const override {
    return {point_work_name,
            packed(work_.problem, work_.ends, work_.limits, work_.options, work_.has_store)};
  }

  std::string run(int task, const std::string& needed, TaskCaller& caller) override {
    return work_.run(task, needed, caller);
  }

  std::string reply(int /*task*/, const std::string& question) override {
    return reply_of(*execution_.store, question);
  }

  void take(int task, const std::string& answer) override {
    add(task, unpacked<FoundPoint>(answer).point);
  }

  void fail(int task, const std::string& failure) override {
    ParetoPoint point;
    point.limit = limit(task);
    point.result.message = "the search was lost: " + failure;
    point.result.x = start_design(work_.problem);
    add(task, std::move(point));
  }

  /// Those that were found, in the order of limits.
  std::vector<ParetoPoint> take_points() {
    std::vector<ParetoPoint> found;
    for (std::optional<ParetoPoint>& point : points_) {
      if (point) found.push_back(std::move(*point));
    }
    return found;
  }

 private:
  std::size_t number(int task) const { return static_cast<std::size_t>(order_.points[task]); }

  double limit(int task) const {
    const ParetoSettings& settings = *work_.problem.pareto;
    return std::lerp(settings.from, settings.to,
                     static_cast<double>(number(task)) / std::max(settings.points - 1, 1));
  }

  void add(int task, ParetoPoint point) {
    if (observer_) observer_(point);
    points_[number(task)] = std::move(point);
  }

  PointWork work_;
  const Execution& execution_;
  const ParetoObserver& observer_;
  ParetoOrder order_;
  std::vector<std::optional<ParetoPoint>> points_;  ///< by their number on the front
};

}  // namespace

std::unique_ptr<TaskWork> make_point_work(const std::string& content) {
  auto work = std::make_unique<PointWork>();
  unpack(content, work->problem, work->ends, work->limits, work->options, work->has_store);
  return work;
}

ParetoOrder pareto_order(int points) {
  ParetoOrder order;
  std::map<int, int> places;  // of the points that are in the order
  const auto add = [&](int point, std::optional<int> from) {
    places[point] = static_cast<int>(order.points.size());
    order.points.push_back(point);
    order.from.push_back(from);
  };
  if (points > 0) add(0, std::nullopt);
  if (points > 1) add(points - 1, std::nullopt);
  while (static_cast<int>(order.points.size()) < points) {
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

bool ParetoPoint::keeps_limits() const {
  if (result.max_violation > Tolerances().violation) return false;
  return result.status == Status::verified || result.status == Status::unresolved ||
         result.status == Status::stalled;
}

void mark_dominated(std::vector<ParetoPoint>& points, GoodSide side) {
  for (ParetoPoint& point : points) {
    if (!point.keeps_limits()) continue;
    point.is_dominated = std::any_of(points.begin(), points.end(), [&](const ParetoPoint& other) {
      return other.keeps_limits() && dominates(other, point, side);
    });
  }
}

namespace {

/// Of the worst case it stands in all of them, and bears the name that the response has there.
std::string name_of_limit_on(const Objective& goal, const ProblemFile& problem) {
  if (goal.over_cases != OverCases::worst) return goal.response;
  for (std::size_t i = 0; i < problem.responses.size(); ++i) {
    if (problem.responses[i].name != goal.response) continue;
    return problem.cases.front().responses[problem.case_responses[i].index].name;
  }
  return goal.response;
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

namespace {

/// An end as a point of the front.
FoundPoint point_of(const FrontEnd& end, const ProblemFile& problem, const Execution& execution) {
  FoundPoint found;
  found.start = end.result.x;
  ParetoPoint& point = found.point;
  point.is_end = true;
  point.result = end.result;
  point.limit = point.limited_value = end.values[1];
  if (!point.has_design()) return found;
  ProblemFile limited = problem;
  set_limit(limited, point.limit);
  DesignProblem design(std::move(limited), available_threads(), execution.store);
  Result& result = point.result;
  result.evaluation = design.evaluate(result.x, Request::values_and_gradients);
  result.constraint_multipliers = Eigen::VectorXd::Zero(result.evaluation.constraints.size());
  result.error.reset();  // of the response that it is best for
  return found;
}

std::vector<ParetoPoint> points_of(Front& front, const Execution& execution) {
  try {
    run_tasks(front, execution.tasks);
    return front.take_points();
  } catch (const Stopped&) {
    std::vector<ParetoPoint> points = front.take_points();
    if (points.empty()) throw;
    return points;
  }
}

/// Between two responses; one point if there is nothing to trade.
std::vector<ParetoPoint> front_between(ProblemFile problem, const SolveOptions& options,
                                       const Execution& execution, const ParetoObserver& observer) {
  ProblemFile file = problem;
  remove_limit(file, file.pareto->constraint);
  std::vector<FoundPoint> ends;
  for (const FrontEnd& end : find_front_ends(file, options, execution)) {
    ends.push_back(point_of(end, problem, execution));
  }
  ParetoSettings& settings = *problem.pareto;
  settings.from = ends[0].point.limit;
  settings.to = ends[1].point.limit;
  const bool has_ends = ends[0].point.has_design() && ends[1].point.has_design();
  const double length = std::abs(settings.to - settings.from);
  if (!has_ends || length <= optimum_resolution * std::abs(settings.from)) {
    if (has_ends) ends.pop_back();
    std::vector<ParetoPoint> points;
    for (FoundPoint& end : ends) {
      if (observer) observer(end.point);
      points.push_back(std::move(end.point));
    }
    return points;
  }
  Front front(problem, std::move(ends), options, execution, observer);
  return points_of(front, execution);
}

}  // namespace

std::vector<ParetoPoint> pareto_front(const ProblemFile& problem, const SolveOptions& options,
                                      const Execution& execution, const ParetoObserver& observer) {
  if (!problem.pareto) throw InputError("/pareto is missing: it says which limit to vary");
  DesignProblem{problem};  // says what is missing
  std::vector<ParetoPoint> points;
  if (problem.pareto->goals.empty()) {
    Front front(problem, {}, options, execution, observer);
    points = points_of(front, execution);
  } else {
    points = front_between(problem, options, execution, observer);
  }
  const ConstraintSettings& varied = problem.constraints[varied_rows(problem).front()];
  mark_dominated(points, varied.upper ? GoodSide::low : GoodSide::high);
  return points;
}

}  // namespace pleuel
