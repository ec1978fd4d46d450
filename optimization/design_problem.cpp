#include "optimization/design_problem.hpp"

#include <fmt/format.h>

#include "core/base/stopwatch.hpp"
#include "optimization/setting_text.hpp"

namespace pleuel {

namespace {

std::string text_in(const ShownUnit& unit, double value) {
  const std::string name = unit.name == "1" ? "" : " " + unit.name;
  return fmt::format("{:.6g}{}", unit.shown(value), name);
}

}  // namespace

DesignProblem::DesignProblem(ProblemFile file, int threads, EvaluationStore* store)
    : file_(std::move(file)), threads_(threads), store_(store) {
  if (store_) setting_ = setting_text(file_);
  if (file_.variables.empty())
    throw InputError("/variables is missing: there is nothing to design");
  variable_units_ = variable_units(file_);
  if (!file_.objective) throw InputError("/objective is missing: there is nothing to minimize");
  for (const DesignVariable& variable : file_.variables) {
    variables_.push_back({variable.name, variable.start, variable.lower, variable.upper});
  }
  for (const ConstraintSettings& constraint : file_.constraints) {
    constraints_.push_back({constraint.name, constraint.lower.value_or(-infinity),
                            constraint.upper.value_or(infinity)});
  }
}

void DesignProblem::start_from(const Eigen::VectorXd& x) {
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    variables_[i].start = x(i);
  }
}

std::string DesignProblem::variable_text(std::size_t variable, double value) const {
  return text_in(variable_units_[variable], value);
}

std::string DesignProblem::constraint_text(std::size_t constraint, double value) const {
  return text_in(unit_of(file_, file_.constraints[constraint]), value);
}

std::string DesignProblem::objective_name() const {
  return (objective_sign() < 0.0 ? "-" : "") + file_.objective->response;
}

std::string DesignProblem::objective_text(double value) const {
  return text_in(unit_of(find_response(file_, file_.objective->response)),
                 objective_sign() * value);
}

std::size_t DesignProblem::response_index(const std::string& name) const {
  for (std::size_t i = 0; i < file_.responses.size(); ++i) {
    if (file_.responses[i].name == name) return i;
  }
  throw InputError(fmt::format("there is no response \"{}\"", name));
}

Eigen::VectorXd DesignProblem::variable_deviations() const {
  Eigen::VectorXd deviations = Eigen::VectorXd::Zero(file_.variables.size());
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
  const RowsOf as_they_are = [this](const Analysis&) {
    std::vector<ConstraintRow> rows;
    for (std::size_t i = 0; i < constraints_.size(); ++i) rows.push_back({i, std::nullopt});
    return rows;
  };
  return evaluate_rows(x, request, {"constraints", as_they_are});
}

std::optional<std::size_t> DesignProblem::response_of(const ConstraintRow& row) const {
  if (!row.constraint) return response_index(file_.objective->response);
  const std::string& name = file_.constraints[*row.constraint].response;
  if (name.empty()) return std::nullopt;
  return response_index(name);
}

double DesignProblem::row_value(const Analysis& analysis, const ConstraintRow& row) const {
  if (row.peak) return (row.constraint ? 1.0 : objective_sign()) * row.peak->value;
  if (const auto response = response_of(row)) return analysis.reductions[*response].value;
  double sum = 0.0;
  for (const auto& [variable, factor] : file_.constraints[*row.constraint].linear) {
    sum += factor * x_(variable);
  }
  return sum;
}

/// Of the objective, then of the rows that limit a response.
Eigen::MatrixXd DesignProblem::gradients_of(Analysis& analysis, const RowsOf& rows_of) {
  const std::size_t objective = response_index(file_.objective->response);
  std::vector<SampledValue> values{{objective, analysis.reductions[objective].samples}};
  for (const ConstraintRow& row : rows_of(analysis)) {
    const auto response = response_of(row);
    if (!response) continue;
    values.push_back(
        {*response, row.peak ? row.peak->samples : analysis.reductions[*response].samples});
  }
  if (!choice_) choice_ = choose_gradients(file_.sensitivity.method, analysis, values);
  if (!is_difference(choice_->method)) {
    Eigen::MatrixXd gradients = sampled_gradients(analysis, values, exact_method(choice_->method));
    gradients.row(0) *= objective_sign();
    Eigen::Index next = 1;
    for (const ConstraintRow& row : rows_of(analysis)) {
      if (!response_of(row)) continue;
      if (!row.constraint) gradients.row(next) *= objective_sign();
      ++next;
    }
    return gradients;
  }
  const ValuesOf numbers = [&](const Analysis& at) {
    std::vector<double> all{objective_sign() * at.reductions[objective].value};
    for (const ConstraintRow& row : rows_of(at)) {
      if (response_of(row)) all.push_back(row_value(at, row));
    }
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size())));
  };
  return gradients_by_differences(file_, x_, analysis, choice_->method, numbers,
                                  {file_.sensitivity.difference_step, threads_});
}

EvaluationKey DesignProblem::key_of(const Eigen::VectorXd& x, Request request,
                                    const std::string& rows) const {
  const GradientMethod method = choice_ ? choice_->method : file_.sensitivity.method;
  const bool is_open = method == GradientMethod::automatic;
  const bool has_method = request == Request::values_and_gradients && !is_open;
  return {setting_, rows, has_method ? to_string(method) : "", request, x};
}

Evaluation DesignProblem::recalled(const StoredEvaluation& stored) {
  if (!stored.failure.empty()) throw SimulationError(stored.failure);
  if (!choice_ && !stored.method.empty()) {
    choice_ = GradientChoice{gradient_method(stored.method), stored.reason};
  }
  return stored.evaluation;
}

Evaluation DesignProblem::evaluate_rows(const Eigen::VectorXd& x, Request request,
                                        const NamedRows& rows) {
  if (!store_) return simulated_rows(x, request, rows.of);
  const EvaluationKey key = key_of(x, request, rows.name);
  if (const auto known = store_->find(key)) return recalled(*known);
  const Stopwatch stopwatch;
  StoredEvaluation stored;
  try {
    stored.evaluation = simulated_rows(x, request, rows.of);
  } catch (const SimulationError& error) {
    stored.failure = error.what();
    stored.seconds = stopwatch.seconds();
    store_->keep(key, stored);
    throw;
  }
  if (request == Request::values_and_gradients) {
    stored.method = to_string(choice_->method);
    stored.reason = choice_->reason;
  }
  stored.seconds = stopwatch.seconds();
  store_->keep(key, stored);
  return std::move(stored.evaluation);
}

Evaluation DesignProblem::simulated_rows(const Eigen::VectorXd& x, Request request,
                                         const RowsOf& rows_of) {
  Analysis& analysis = analysis_at(x);
  const std::vector<ConstraintRow> rows = rows_of(analysis);
  const std::size_t objective = response_index(file_.objective->response);
  const auto count = static_cast<Eigen::Index>(rows.size());
  Evaluation evaluation;
  evaluation.objective = objective_sign() * analysis.reductions[objective].value;
  evaluation.constraints.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    evaluation.constraints(i) = row_value(analysis, rows[i]);
  }
  if (request == Request::values) return evaluation;

  const Eigen::MatrixXd gradients = gradients_of(analysis, rows_of);
  evaluation.objective_gradient = gradients.row(0);
  evaluation.constraint_jacobian = Eigen::MatrixXd::Zero(count, x.size());
  Eigen::Index next = 1;
  for (Eigen::Index i = 0; i < count; ++i) {
    const ConstraintRow& row = rows[i];
    if (response_of(row)) {
      evaluation.constraint_jacobian.row(i) = gradients.row(next++);
      continue;
    }
    for (const auto& [variable, factor] : file_.constraints[*row.constraint].linear) {
      evaluation.constraint_jacobian(i, variable) += factor;
    }
  }
  return evaluation;
}

}  // namespace pleuel
