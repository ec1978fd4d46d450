#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "optimization/design/size_choice.hpp"
#include "optimization/design/staged_solve.hpp"

/// Optimization from several designs: local methods find the optimum of the basin that they begin
/// in.
namespace pleuel {

/// What the search from one design came to.
struct StartRun {
  Eigen::VectorXd start;  ///< [SI]
  Status status = Status::failed;
  double objective = 0.0;      ///< [SI]; meaningless if the start failed
  double max_violation = 0.0;  ///< relative
  int evaluations = 0;
  std::optional<std::size_t> optimum;  ///< index in MultiStart::optima
};

/// A local optimum, found from one or several designs.
struct LocalOptimum {
  Eigen::VectorXd x;                ///< [SI]
  double objective = 0.0;           ///< [SI]
  std::vector<std::size_t> starts;  ///< indices in MultiStart::runs
};

struct MultiStart {
  StagedSolution best;  ///< with the effort and the history of all
  std::vector<StartRun> runs;
  std::vector<LocalOptimum> optima;  ///< distinct ones, the best first
};

/// The designs that a file asks for: `first`, then those that it gives, or a Latin hypercube between
/// the bounds (latin_hypercube()). The same every time.
/// @param count  how many in all; of a file that gives designs these are all taken
std::vector<Eigen::VectorXd> starts_of(const ProblemFile& file, const Eigen::VectorXd& first,
                                       int count);

/// Puts the searches from several designs together: which optima are distinct (objectives further
/// apart than 0.1 %, or variables by more than 2 % of their magnitude), how often each was found,
/// and the best: proven before unproven, within the limits before outside.
/// @param solutions  one a start; the problems of all but the best are not needed
MultiStart combined(const std::vector<Eigen::VectorXd>& starts,
                    std::vector<StagedSolution> solutions);

/// solve_in_stages() from each design, each independent of the others and, where they are several,
/// in a process of its own (core/jobs/tasks.hpp): one that crashes is a start that failed. Observer
/// and notice hear of them in their order. Answers do not depend on the number of jobs.
/// @throws as solve()
MultiStart solve_from_starts(const ProblemFile& file, const std::vector<Eigen::VectorXd>& starts,
                             SearchSetup setup);

/// The searches of solve_from_starts(), made again on another rank (PackedWork).
inline constexpr const char* search_work_name = "searches";
std::unique_ptr<TaskWork> make_search_work(const std::string& content);

/// What a search came to.
struct WholeSearch {
  MultiStart all;
  std::optional<SizeChoiceReport> sizes;  ///< where some are chosen from lists
};

/// All that an optimization of a problem file does: solve_from_starts(), then choose_sizes() where sizes are
/// chosen from lists. A request to stop ends it with the best design so far, of which nothing is proven
/// (`interrupted`).
/// @throws Stopped before the first design was simulated; and as solve_from_starts()
WholeSearch search_design(const ProblemFile& file, const std::vector<Eigen::VectorXd>& starts,
                          const SearchSetup& setup);

}  // namespace pleuel
