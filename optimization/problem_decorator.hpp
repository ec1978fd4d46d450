#pragma once

#include "optimization/problem.hpp"

namespace pleuel {

/// Another problem, whose answers derived classes change or follow: the base of all that makes one problem of
/// another with the same variables.
class ProblemDecorator : public Problem {
 public:
  /// @param problem  must outlive this
  explicit ProblemDecorator(Problem& problem) : problem_(problem) {}

  const std::vector<Variable>& variables() const override { return problem_.variables(); }
  const std::vector<Constraint>& constraints() const override { return problem_.constraints(); }
  std::string objective_name() const override { return problem_.objective_name(); }
  std::string variable_text(std::size_t variable, double value) const override {
    return problem_.variable_text(variable, value);
  }
  std::string constraint_text(std::size_t constraint, double value) const override {
    return problem_.constraint_text(constraint, value);
  }
  Evaluation evaluate(const Eigen::VectorXd& x, Request request) override {
    return problem_.evaluate(x, request);
  }

 protected:
  Problem& problem() { return problem_; }

 private:
  Problem& problem_;
};

/// A problem that begins at another design.
class StartedProblem : public ProblemDecorator {
 public:
  StartedProblem(Problem& problem, const Eigen::VectorXd& start)
      : ProblemDecorator(problem), variables_(problem.variables()) {
    set_start(variables_, start);
  }

  const std::vector<Variable>& variables() const override { return variables_; }

 private:
  std::vector<Variable> variables_;
};

}  // namespace pleuel
