#pragma once

#include "core/response/response.hpp"
#include "optimization/problem.hpp"

namespace pleuel {

/// The optimization problem that a problem file describes: responses of the simulated mechanism as
/// objective and constraints, gradients by direct differentiation.
class DesignProblem : public Problem {
 public:
  /// @throws InputError if the file has no variables or no objective
  explicit DesignProblem(ProblemFile file);

  const std::vector<Variable>& variables() const override { return variables_; }
  const std::vector<Constraint>& constraints() const override { return constraints_; }
  std::string objective_name() const override { return file_.objective->response; }

  /// The simulation of the design seen last is kept, so that its gradients cost no second one.
  Evaluation evaluate(const Eigen::VectorXd& x, Request request) override;

  const ProblemFile& file() const { return file_; }

 private:
  Analysis& analysis_at(const Eigen::VectorXd& x);
  Eigen::Index response_index(const std::string& name) const;

  ProblemFile file_;
  std::vector<Variable> variables_;
  std::vector<Constraint> constraints_;
  Eigen::VectorXd x_;
  std::unique_ptr<Analysis> analysis_;
};

}  // namespace pleuel
