#pragma once

#include <memory>

#include "optimization/design/design_problem.hpp"
#include "optimization/solve.hpp"

namespace pleuel {

/// The best design of a file for one point of a front.
struct SizedDesign {
  Result result;
  std::unique_ptr<DesignProblem> problem;  ///< that it is a design of
  Eigen::VectorXd between;  ///< the optimum between the sizes, where some come from lists [SI]
};

/// solve_design(), and choose_sizes() after it where sizes are chosen from lists. Where no choice
/// could be simulated the result has no design.
/// @param file  with the design that the search begins at
/// @throws as solve()
SizedDesign search_with_sizes(const ProblemFile& file, const SolveOptions& options,
                              EvaluationStore* store);

}  // namespace pleuel
