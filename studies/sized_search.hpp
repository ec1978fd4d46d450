#pragma once

#include <memory>
#include <optional>

#include "optimization/design/design_problem.hpp"
#include "optimization/solve.hpp"

namespace pleuel {

/// How sizes were chosen from lists.
struct TriedSizes {
  double combinations = 1.0;
  int tried = 0;
  bool is_exhaustive = false;  ///< all were: the design is the best of them
  /// By how much the objective may be above that of the best choice: relative to the optimum between
  /// the sizes, which no choice can beat if it is the global one.
  double penalty = 0.0;
};

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

}  // namespace pleuel
