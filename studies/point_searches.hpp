#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/problem_file.hpp"
#include "optimization/evaluation_store.hpp"
#include "optimization/solve.hpp"
#include "studies/pareto_point.hpp"

/// The searches for points of a front, each a task of its own (core/jobs/tasks.hpp).
namespace pleuel {

/// A point, and the design that its search began at.
struct FoundPoint {
  Eigen::VectorXd start;    ///< [SI]
  Eigen::VectorXd between;  ///< the optimum between sizes from lists; empty without them [SI]
  ParetoPoint point;

  /// Where the search for a neighbour begins: where that broke its limits, where it began itself.
  const Eigen::VectorXd& next_start() const {
    if (!point.keeps_limits()) return start;
    return between.size() > 0 ? between : point.result.x;
  }
};

/// A point that is looked for: the best design with this limit.
struct PointSearch {
  double limit = 0.0;            ///< [SI]
  std::optional<int> from = {};  ///< an earlier search, whose next_start() it begins at
  std::optional<Eigen::VectorXd> start = {};  ///< [SI]; neither: the start of the file
  std::optional<Eigen::VectorXd> other =
      {};  ///< start where the other one leads to no design within limits
  std::optional<FoundPoint> known = {};  ///< nothing has to be looked for
  /// In place of the limit one on the objective (ParetoPoint::objective_limit).
  std::optional<double> objective_limit = {};
  bool keeps_sizes = false;  ///< those of the start are judged, and no others looked for
};

struct FoundPoints {
  std::vector<FoundPoint> points;  ///< in the order of the searches; those that were found
  bool is_whole = true;            ///< no stop was asked for before their end
};

/// The design of a result of another problem as a point: judged by that, with its own value as the limit.
/// @param problem  of the front
void take_as_point(ParetoPoint& point, const ProblemFile& problem, EvaluationStore* store);

/// Sees each point as it is found; dominance is known only at the end.
using ParetoObserver = std::function<void(const ParetoPoint&)>;

/// The points do not depend on the number of jobs; every one is audited like any optimum.
FoundPoints search_points(const ProblemFile& problem, const std::vector<PointSearch>& searches,
                          const SolveOptions& options, const Execution& execution,
                          const ParetoObserver& observer);

/// The searches, made again on another rank (PackedWork).
inline constexpr const char* point_work_name = "points";
std::unique_ptr<TaskWork> make_point_work(const std::string& content);

}  // namespace pleuel
