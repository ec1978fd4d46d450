#include "optimization/design_problem.hpp"

#include <fmt/format.h>

#include "sensitivity/gradients.hpp"

namespace pleuel {

DesignProblem::DesignProblem(ProblemFile file) : file_(std::move(file)) {
  if (file_.variables.empty())
    throw InputError("/variables is missing: there is nothing to design");
  if (!file_.objective) throw InputError("/objective is missing: there is nothing to minimize");
  for (const DesignVariable& variable : file_.variables) {
    variables_.push_back({variable.name, variable.start, variable.lower, variable.upper});
  }
  for (const ConstraintSettings& constraint : file_.constraints) {
    constraints_.push_back({constraint.name, constraint.lower.value_or(-infinity),
                            constraint.upper.value_or(infinity)});
  }
}

Eigen::Index DesignProblem::response_index(const std::string& name) const {
  for (std::size_t i = 0; i < file_.responses.size(); ++i) {
    if (file_.responses[i].name == name) return static_cast<Eigen::Index>(i);
  }
  throw InputError(fmt::format("there is no response \"{}\"", name));
}

Analysis& DesignProblem::analysis_at(const Eigen::VectorXd& x) {
  if (!analysis_ || x != x_) {
    analysis_.reset();  // a failing simulation leaves nothing stale behind
    analysis_ = analyze(file_, x);
    x_ = x;
  }
  return *analysis_;
}

Evaluation DesignProblem::evaluate(const Eigen::VectorXd& x, Request request) {
  Analysis& analysis = analysis_at(x);
  const bool wants_gradients = request == Request::values_and_gradients;
  Eigen::MatrixXd gradients;
  if (wants_gradients) gradients = direct_gradients(analysis);
  const auto value = [&](Eigen::Index i) {
    return analysis.reductions[static_cast<std::size_t>(i)].value;
  };
  const auto rows = static_cast<Eigen::Index>(constraints_.size());
  const Eigen::Index objective = response_index(file_.objective->response);
  Evaluation evaluation;
  evaluation.objective = value(objective);
  evaluation.constraints.resize(rows);
  if (wants_gradients) {
    evaluation.objective_gradient = gradients.row(objective);
    evaluation.constraint_jacobian = Eigen::MatrixXd::Zero(rows, x.size());
  }
  for (Eigen::Index i = 0; i < rows; ++i) {
    const ConstraintSettings& constraint = file_.constraints[static_cast<std::size_t>(i)];
    if (!constraint.response.empty()) {
      const Eigen::Index response = response_index(constraint.response);
      evaluation.constraints(i) = value(response);
      if (wants_gradients) evaluation.constraint_jacobian.row(i) = gradients.row(response);
      continue;
    }
    Eigen::VectorXd coefficients = Eigen::VectorXd::Zero(x.size());
    for (const auto& [variable, factor] : constraint.linear) coefficients(variable) += factor;
    evaluation.constraints(i) = coefficients.dot(x);
    if (wants_gradients) evaluation.constraint_jacobian.row(i) = coefficients;
  }
  return evaluation;
}

}  // namespace pleuel
