#pragma once

#include "optimization/searched_problem.hpp"

namespace pleuel {

/// A problem to be searched that is smooth as it is: its rows are its limits.
class SmoothProblem : public SearchedProblem {
 public:
  /// @param problem  must outlive this
  explicit SmoothProblem(Problem& problem) : problem_(problem) {}

  Problem& problem() override { return problem_; }
  Result attempt(const Eigen::VectorXd& start, const SolveOptions& options,
                 const Observer& observer) override;
  LimitRows limit_rows() override;

 private:
  Problem& problem_;
};

}  // namespace pleuel
