#pragma once

#include "optimization/problem.hpp"

namespace pleuel {

/// Another problem, whose answers derived classes change or follow.
class ForwardingProblem : public Problem {
 public:
  /// @param problem  must outlive this
  explicit ForwardingProblem(Problem& problem) : problem_(problem) {}

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

}  // namespace pleuel
