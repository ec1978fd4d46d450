#include "optimization/smooth_problem.hpp"

#include "core/base/eager_matrices.hpp"
#include "optimization/forwarding_problem.hpp"

namespace pleuel {

namespace {

/// A problem that begins at another design.
class StartedProblem : public ForwardingProblem {
 public:
  StartedProblem(Problem& problem, const Eigen::VectorXd& start)
      : ForwardingProblem(problem), variables_(problem.variables()) {
    for (std::size_t i = 0; i < variables_.size(); ++i) variables_[i].start = start[i];
  }

  const std::vector<Variable>& variables() const override { return variables_; }

 private:
  std::vector<Variable> variables_;
};

}  // namespace

Result SmoothProblem::attempt(const Eigen::VectorXd& start, const SolveOptions& options,
                              const Observer& observer) {
  StartedProblem started(problem_, start);
  return solve(started, options, observer);
}

LimitRows SmoothProblem::limit_rows() {
  LimitRows rows{&problem_, {}};
  for (std::size_t i = 0; i < problem_.constraints().size(); ++i) {
    rows.constraint_of_row.push_back(i);
  }
  return rows;
}

}  // namespace pleuel
