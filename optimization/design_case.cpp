#include "optimization/design_case.hpp"

#include <utility>

#include <fmt/format.h>

#include "core/base/stopwatch.hpp"
#include "optimization/setting_text.hpp"

namespace pleuel {

DesignCase::DesignCase(ProblemFile file, int threads, EvaluationStore* store)
    : file_(std::move(file)), threads_(threads), store_(store) {
  if (store_) setting_ = setting_text(file_);
}

std::size_t DesignCase::response_index(const std::string& name) const {
  for (std::size_t i = 0; i < file_.responses.size(); ++i) {
    if (file_.responses[i].name == name) return i;
  }
  throw InputError(fmt::format("there is no response \"{}\"", name));
}

Analysis& DesignCase::analysis_at(const Eigen::VectorXd& x) {
  if (!analysis_ || x != x_) {
    analysis_.reset();  // a failing simulation leaves nothing stale behind
    analysis_ = analyze(file_, x);
    x_ = x;
  }
  return *analysis_;
}

std::optional<std::size_t> DesignCase::response_of(const ConstraintRow& row) const {
  if (row.part) return row.part;
  if (!row.constraint) return response_index(file_.objective->response);
  const std::string& name = file_.constraints[*row.constraint].response;
  if (name.empty()) return std::nullopt;
  return response_index(name);
}

double DesignCase::row_value(const Analysis& analysis, const ConstraintRow& row) const {
  if (row.peak) return (row.constraint ? 1.0 : objective_sign()) * row.peak->value;
  if (const auto response = response_of(row)) {
    return (row.constraint ? 1.0 : objective_sign()) * analysis.reductions[*response].value;
  }
  double sum = 0.0;
  for (const auto& [variable, factor] : file_.constraints[*row.constraint].linear) {
    sum += factor * x_(variable);
  }
  return sum;
}

/// Of the objective, then of the rows that limit a response.
Eigen::MatrixXd DesignCase::gradients_of(Analysis& analysis, const RowsOf& rows_of) {
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

EvaluationKey DesignCase::key_of(const Eigen::VectorXd& x, Request request,
                                 const std::string& rows) const {
  const GradientMethod method = choice_ ? choice_->method : file_.sensitivity.method;
  const bool is_open = method == GradientMethod::automatic;
  const bool has_method = request == Request::values_and_gradients && !is_open;
  return {setting_, rows, has_method ? to_string(method) : "", request, x};
}

std::optional<DesignCase::Answer> DesignCase::recall(const Eigen::VectorXd& x, Request request,
                                                     const std::string& rows) {
  if (!store_) return std::nullopt;
  asked_ = key_of(x, request, rows);
  const auto stored = store_->find(*asked_);
  if (!stored) return std::nullopt;
  Answer answer;
  answer.is_known = true;
  answer.seconds = stored->seconds;
  if (!stored->failure.empty()) {
    answer.failure = std::make_exception_ptr(SimulationError(stored->failure));
    return answer;
  }
  if (!choice_ && !stored->method.empty()) {
    choice_ = GradientChoice{gradient_method(stored->method), stored->reason};
  }
  answer.evaluation = stored->evaluation;
  return answer;
}

DesignCase::Answer DesignCase::compute(const Eigen::VectorXd& x, Request request,
                                       const RowsOf& rows_of) {
  const Stopwatch stopwatch;
  Answer answer;
  try {
    answer.evaluation = simulated_rows(x, request, rows_of);
  } catch (const SimulationError&) {
    answer.failure = std::current_exception();
  }
  answer.seconds = stopwatch.seconds();
  return answer;
}

void DesignCase::keep(Request request, const Answer& answer) {
  if (!store_ || answer.is_known) return;
  StoredEvaluation stored;
  stored.seconds = answer.seconds;
  if (answer.failure) {
    try {
      std::rethrow_exception(answer.failure);
    } catch (const SimulationError& error) {
      stored.failure = error.what();
    }
  } else {
    stored.evaluation = answer.evaluation;
    if (request == Request::values_and_gradients) {
      stored.method = to_string(choice_->method);
      stored.reason = choice_->reason;
    }
  }
  store_->keep(*asked_, stored);
}

Evaluation DesignCase::simulated_rows(const Eigen::VectorXd& x, Request request,
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
