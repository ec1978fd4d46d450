#pragma once

#include "optimization/design/design_problem.hpp"
#include "optimization/evaluation_store.hpp"
#include "optimization/solve.hpp"
#include "studies/pareto_point.hpp"

/// The searches for points of a front, each a task of its own (core/jobs/tasks.hpp).
namespace pleuel {

/// The best design of a file for one point of a front.
struct SizedDesign {
  Result result;
  std::unique_ptr<DesignProblem> problem;  ///< that it is a design of
  Eigen::VectorXd between;  ///< the optimum between the sizes, where some come from lists [SI]
  std::optional<TriedSizes> sizes;  ///< where some come from lists
};

/// solve_design(), and choose_sizes() after it where sizes are chosen from lists. Where no choice
/// could be simulated the result has no design.
/// @param file  with the design that the search begins at
/// @throws as solve()
SizedDesign search_with_sizes(const ProblemFile& file, const SolveOptions& options,
                              EvaluationStore* store);

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
  /// Another problem that is solved in place of that of the front with this limit: its design is made a
  /// point, judged by the problem of the front, with its own value as the limit.
  std::optional<ProblemFile> other_problem = {};
  std::optional<double> objective_limit = {};  ///< that the other problem has (ParetoPoint)
  bool keeps_sizes = false;  ///< those of the start are judged, and no others looked for
};

struct FoundPoints {
  std::vector<FoundPoint> points;  ///< in the order of the searches; those that were found
  bool is_whole = true;            ///< no stop was asked for before their end
};

/// Sees each point as it is found; dominance is known only at the end.
using ParetoObserver = std::function<void(const ParetoPoint&)>;

/// The points do not depend on the number of jobs; every one is audited like any optimum.
FoundPoints search_points(const ProblemFile& problem, const std::vector<PointSearch>& searches,
                          const SolveOptions& options, const Execution& execution,
                          const ParetoObserver& observer = {});

/// Sets starts, within the bounds exactly: an optimum may miss them by rounding.
void start_from(const Eigen::VectorXd& x, std::vector<DesignVariable>& variables);

/// The searches, made again on another rank (PackedWork).
inline constexpr const char* point_work_name = "points";
std::unique_ptr<TaskWork> make_point_work(const std::string& content);

/// The ends of a front between two responses: the best design for each of them.
struct FrontEnds {
  std::vector<FoundPoint> points;
  std::array<GoalScale, 2> scales;  ///< of both responses between the ends
};

/// The best designs for both responses (ParetoSettings::goals), and of equally good ones the best for
/// the other. Each search is a task of its own.
/// @param problem  that of trade_off_problem()
/// @returns two, whatever became of their searches
FrontEnds find_front_ends(const ProblemFile& problem, const SolveOptions& options,
                          const Execution& execution);

}  // namespace pleuel
