#include "studies/pareto.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/find_named.hpp"
#include "core/base/parallel.hpp"
#include "core/base/stop.hpp"
#include "core/base/tasks.hpp"
#include "optimization/design_problem.hpp"
#include "optimization/design_solve.hpp"
#include "optimization/packed_result.hpp"

namespace pleuel {

namespace {

/// Optima agree to about this, relative: what differs by less is the same.
constexpr double resolution = 1e-4;

const ConstraintSettings& find_varied(const ProblemFile& problem) {
  const ConstraintSettings* found = find_named(problem.constraints, problem.pareto->constraint);
  if (!found) throw InputError("/pareto/constraint names no constraint");
  return *found;
}

Eigen::Index varied_row(const ProblemFile& problem) {
  return &find_varied(problem) - problem.constraints.data();
}

void set_limit(ConstraintSettings& constraint, double limit) {
  (constraint.upper ? constraint.upper : constraint.lower) = limit;
}

/// Bounds are kept exactly: an optimum may miss them by rounding.
void start_from(const Eigen::VectorXd& x, std::vector<DesignVariable>& variables) {
  for (std::size_t i = 0; i < variables.size(); ++i) {
    variables[i].start = std::clamp(x(i), variables[i].lower, variables[i].upper);
  }
}

bool is_within_limits(const ParetoPoint& point) {
  if (point.result.max_violation > Tolerances().violation) return false;
  const Status status = point.result.status;
  return status == Status::verified || status == Status::unresolved || status == Status::stalled;
}

bool dominates(const ParetoPoint& one, const ParetoPoint& other, GoodSide side) {
  const double sign = side == GoodSide::low ? 1.0 : -1.0;
  const double gain = other.result.evaluation.objective - one.result.evaluation.objective;
  const double limited_gain = sign * (other.limited_value - one.limited_value);
  const double least = resolution * std::abs(one.result.evaluation.objective);
  const double least_limited = resolution * std::abs(one.limited_value);
  return gain >= -least && limited_gain >= -least_limited &&
         (gain > least || limited_gain > least_limited);
}

/// A point as an answer of a task, with the design that its search began at.
struct FoundPoint {
  Eigen::VectorXd start;
  ParetoPoint point;

  /// Where the search for a neighbour begins.
  const Eigen::VectorXd& next_start() const {
    return is_within_limits(point) ? point.result.x : start;
  }
};

template <class Archive>
void transfer(Archive& archive, FoundPoint& found) {
  auto& [start, point] = found;
  auto& [limit, limited_value, multiplier, is_dominated, result] = point;
  archive(start, limit, limited_value, multiplier, is_dominated, result);
}

class Front : public Tasks {
 public:
  Front(const ProblemFile& problem, const SolveOptions& options, const Execution& execution,
        const ParetoObserver& observer)
      : problem_(problem),
        options_(options),
        execution_(execution),
        observer_(observer),
        row_(varied_row(problem)),
        order_(pareto_order(problem.pareto->points)),
        points_(order_.points.size()) {}

  int count() const override { return static_cast<int>(order_.points.size()); }

  std::optional<int> needed_by(int task) const override { return order_.from[task]; }

  std::string run(int task, const std::string& needed, TaskCaller& caller) override {
    RemoteStore store(caller);
    FoundPoint found;
    found.start =
        needed.empty() ? start_design(problem_) : unpacked<FoundPoint>(needed).next_start();
    ProblemFile varied = problem_;
    set_limit(varied.constraints[row_], limit(task));
    start_from(found.start, varied.variables);
    DesignProblem design(varied, available_threads(), execution_.store ? &store : nullptr);
    found.point.limit = limit(task);
    found.point.result = solve_design(design, options_);
    if (found.point.has_design()) {
      found.point.limited_value = found.point.result.evaluation.constraints(row_);
      found.point.multiplier = found.point.result.constraint_multipliers(row_);
    }
    return packed(found);
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
    point.result.x = start_design(problem_);
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
    const ParetoSettings& settings = *problem_.pareto;
    return std::lerp(settings.from, settings.to,
                     static_cast<double>(number(task)) / std::max(settings.points - 1, 1));
  }

  void add(int task, ParetoPoint point) {
    if (observer_) observer_(point);
    points_[number(task)] = std::move(point);
  }

  const ProblemFile& problem_;
  const SolveOptions& options_;
  const Execution& execution_;
  const ParetoObserver& observer_;
  Eigen::Index row_;
  ParetoOrder order_;
  std::vector<std::optional<ParetoPoint>> points_;  ///< by their number on the front
};

}  // namespace

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

void mark_dominated(std::vector<ParetoPoint>& points, GoodSide side) {
  for (ParetoPoint& point : points) {
    if (!is_within_limits(point)) continue;
    point.is_dominated = std::any_of(points.begin(), points.end(), [&](const ParetoPoint& other) {
      return is_within_limits(other) && dominates(other, point, side);
    });
  }
}

std::vector<ParetoPoint> pareto_front(const ProblemFile& problem, const SolveOptions& options,
                                      const Execution& execution, const ParetoObserver& observer) {
  if (!problem.pareto) throw InputError("/pareto is missing: it says which limit to vary");
  DesignProblem{problem};  // says what is missing
  Front front(problem, options, execution, observer);
  std::vector<ParetoPoint> points;
  try {
    run_tasks(front, execution.tasks);
    points = front.take_points();
  } catch (const Stopped&) {
    points = front.take_points();
    if (points.empty()) throw;
  }
  const ConstraintSettings& varied = find_varied(problem);
  mark_dominated(points, varied.upper ? GoodSide::low : GoodSide::high);
  return points;
}

}  // namespace pleuel
