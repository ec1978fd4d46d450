#pragma once

#include "optimization/least_violation.hpp"
#include "optimization/solve.hpp"

namespace pleuel {

/// What find_optimum() searches.
class SearchedProblem {
 public:
  virtual ~SearchedProblem() = default;

  /// Its variables begin where the search begins.
  virtual Problem& problem() = 0;
  /// Optimizes from a design with the backend of the options.
  virtual Result attempt(const Eigen::VectorXd& start, const SolveOptions& options,
                         const Observer& observer) = 0;
  /// The limits as rows that are smooth; valid until the next call of anything here.
  virtual LimitRows limit_rows() = 0;
};

}  // namespace pleuel
