#include "optimization/design_problem.hpp"

#include <fmt/format.h>

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

std::size_t DesignProblem::response_index(const std::string& name) const {
  for (std::size_t i = 0; i < file_.responses.size(); ++i) {
    if (file_.responses[i].name == name) return i;
  }
  throw InputError(fmt::format("there is no response \"{}\"", name));
}

Eigen::VectorXd DesignProblem::variable_deviations() const {
  Eigen::VectorXd deviations =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(file_.variables.size()));
  if (!file_.uncertainty) return deviations;
  for (const UncertainParameter& parameter : file_.uncertainty->parameters) {
    deviations(parameter.variable) = parameter.standard_deviation();
  }
  return deviations;
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
  std::vector<ConstraintRow> rows;
  for (std::size_t i = 0; i < constraints_.size(); ++i) rows.push_back({i, std::nullopt});
  return evaluate_rows(x, request, rows);
}

double DesignProblem::row_value(const Analysis& analysis, const ConstraintRow& row) const {
  if (row.peak) return row.peak->value;
  const ConstraintSettings& constraint = file_.constraints[row.constraint];
  if (!constraint.response.empty()) {
    return analysis.reductions[response_index(constraint.response)].value;
  }
  double sum = 0.0;
  for (const auto& [variable, factor] : constraint.linear) sum += factor * x_(variable);
  return sum;
}

Evaluation DesignProblem::evaluate_rows(const Eigen::VectorXd& x, Request request,
                                        const std::vector<ConstraintRow>& rows) {
  Analysis& analysis = analysis_at(x);
  const std::size_t objective = response_index(file_.objective->response);
  const auto count = static_cast<Eigen::Index>(rows.size());
  Evaluation evaluation;
  evaluation.objective = analysis.reductions[objective].value;
  evaluation.constraints.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    evaluation.constraints(i) = row_value(analysis, rows[static_cast<std::size_t>(i)]);
  }
  if (request == Request::values) return evaluation;

  std::vector<SampledValue> values{{objective, analysis.reductions[objective].samples}};
  for (const ConstraintRow& row : rows) {
    const std::string& name = file_.constraints[row.constraint].response;
    if (name.empty()) continue;
    const std::size_t response = response_index(name);
    values.push_back(
        {response, row.peak ? row.peak->samples : analysis.reductions[response].samples});
  }
  if (!choice_) choice_ = choose_method(analysis, values);
  const Eigen::MatrixXd gradients = sampled_gradients(analysis, values, choice_->method);
  evaluation.objective_gradient = gradients.row(0);
  evaluation.constraint_jacobian = Eigen::MatrixXd::Zero(count, x.size());
  Eigen::Index next = 1;
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& constraint = file_.constraints[rows[static_cast<std::size_t>(i)].constraint];
    if (!constraint.response.empty()) {
      evaluation.constraint_jacobian.row(i) = gradients.row(next++);
    }
    for (const auto& [variable, factor] : constraint.linear) {
      evaluation.constraint_jacobian(i, variable) += factor;
    }
  }
  return evaluation;
}

}  // namespace pleuel
