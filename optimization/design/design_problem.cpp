#include "optimization/design/design_problem.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/find_named.hpp"
#include "core/base/int_size.hpp"
#include "core/base/parallel.hpp"
#include "core/scene/load_cases.hpp"

namespace pleuel {

namespace {

std::string text_in(const ShownUnit& unit, double value) {
  return fmt::format("{:.6g}{}", unit.shown(value), unit.suffix());
}

}  // namespace

DesignProblem::DesignProblem(ProblemFile file, int threads, EvaluationStore* store)
    : file_(std::move(file)), threads_(std::max(1, threads)) {
  if (file_.variables.empty())
    throw InputError("/variables is missing: there is nothing to design");
  variable_units_ = variable_units(file_);
  if (!file_.objective && !file_.load_case.empty()) {
    throw InputError(fmt::format(
        "/objective is made from several cases, or missing: the case \"{}\" alone has none",
        file_.load_case));
  }
  if (!file_.objective) throw InputError("/objective is missing: there is nothing to minimize");
  for (const DesignVariable& variable : file_.variables) {
    variables_.push_back({variable.name, variable.start, variable.lower, variable.upper});
  }
  for (const ConstraintSettings& constraint : file_.constraints) {
    constraints_.push_back({constraint.name, constraint.lower.value_or(-infinity),
                            constraint.upper.value_or(infinity)});
  }
  const auto problems = simulated_problems(std::as_const(file_));
  const auto count = int_size(problems);
  const int inner_threads = std::max(1, threads_ / count);
  for (const ProblemFile* problem : problems) {
    cases_.push_back(std::make_unique<DesignCase>(*problem, inner_threads, store));
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
  if (const auto index = index_of_named(file_.responses, name)) return *index;
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

LinearizedResponse DesignProblem::linearized_at(const Eigen::VectorXd& x, std::size_t response) {
  if (!is_over_cases(file_, response)) return {{{response, 1.0}}, Eigen::VectorXd::Zero(x.size())};
  return linearized_over_cases(file_, response, x,
                               [&](std::size_t part) { return value_at(x, part); });
}

double DesignProblem::value_at(const Eigen::VectorXd& x, std::size_t response) {
  return value_over_cases(file_, response, x, [&](std::size_t part) {
    const OfCase of_case = case_of_response(file_, part);
    return load_case(of_case.load_case).analysis_at(x).reductions[of_case.index].value;
  });
}

std::optional<std::size_t> DesignProblem::response_of(std::size_t constraint) const {
  const std::string& name = file_.constraints[constraint].response;
  if (name.empty()) return std::nullopt;
  return response_index(name);
}

bool DesignProblem::minimizes_worst() const {
  return case_count() > 1 && has_objective_in_cases() &&
         file_.objective->over_cases == OverCases::worst;
}

double DesignProblem::objective_weight(std::size_t load_case) const {
  switch (file_.objective->over_cases) {
    case OverCases::weighted:
      return file_.case_weights[load_case];
    case OverCases::worst:
      return 1.0;
    default:
      return load_case == 0 ? 1.0 : 0.0;
  }
}

Evaluation DesignProblem::evaluate(const Eigen::VectorXd& x, Request request) {
  // Of a case these are its own, fewer than those of the file.
  NamedRows rows{file_.has_cases() ? "constraints of the case" : "constraints", {}};
  rows.cases.resize(case_count());
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    const OfCase of_case = case_of_constraint(file_, i);
    if (is_of_several(of_case)) {
      rows.over_cases.push_back({*response_of(i), static_cast<Eigen::Index>(i)});
      continue;
    }
    rows.cases[of_case.load_case].of.push_back({of_case.index});
    rows.cases[of_case.load_case].places.push_back(i);
  }
  return evaluate_rows(x, request, rows);
}

/// The store belongs to this process and is asked and told in the order of the cases: what it holds
/// and what comes of it does not depend on how many run at a time.
std::vector<DesignCase::Answer> DesignProblem::answers_of(const Eigen::VectorXd& x, Request request,
                                                          const NamedRows& rows) {
  std::vector<DesignCase::Answer> answers(case_count());
  std::vector<std::size_t> open;
  for (std::size_t c = 0; c < case_count(); ++c) {
    if (auto known = cases_[c]->recall(x, request, rows.name, rows.cases[c].of)) {
      answers[c] = std::move(*known);
    } else {
      open.push_back(c);
    }
  }
  for_each_in_parallel(int_size(open), threads_, [&](int i) {
    answers[open[i]] = cases_[open[i]]->compute(x, request, rows.cases[open[i]].of);
  });
  for (const std::size_t c : open) cases_[c]->keep(request, answers[c]);
  for (std::size_t c = 0; c < case_count(); ++c) {
    if (!answers[c].failure) continue;
    if (!file_.has_cases()) std::rethrow_exception(answers[c].failure);
    try {
      std::rethrow_exception(answers[c].failure);
    } catch (const SimulationError& error) {
      throw SimulationError(
          fmt::format("in the case \"{}\": {}", cases_[c]->file().load_case, error.what()));
    }
  }
  return answers;
}

double DesignProblem::objective_of(const std::vector<DesignCase::Answer>& answers,
                                   Eigen::VectorXd* gradient) const {
  if (minimizes_worst()) {
    const auto worst =
        std::max_element(answers.begin(), answers.end(),
                         [](const DesignCase::Answer& one, const DesignCase::Answer& other) {
                           return one.evaluation.objective < other.evaluation.objective;
                         });
    if (gradient) *gradient = worst->evaluation.objective_gradient;
    return worst->evaluation.objective;
  }
  double sum = 0.0;
  if (gradient) *gradient = Eigen::VectorXd::Zero(std::ssize(variables_));
  for (std::size_t c = 0; c < answers.size(); ++c) {
    const double weight = objective_weight(c);
    if (weight == 0.0) continue;
    sum += weight * answers[c].evaluation.objective;
    if (gradient) *gradient += weight * answers[c].evaluation.objective_gradient;
  }
  return sum;
}

std::vector<std::size_t> DesignProblem::responses_over_cases(const NamedRows& rows) const {
  std::vector<std::size_t> responses;
  if (!has_objective_in_cases()) responses.push_back(objective_response());
  for (const RowOverCases& row : rows.over_cases) responses.push_back(row.response);
  return responses;
}

Evaluation DesignProblem::evaluate_rows(const Eigen::VectorXd& x, Request request,
                                        const NamedRows& rows) {
  const PartRows parts(file_, responses_over_cases(rows));
  const std::vector<DesignCase::Answer> answers = answers_of(x, request, parts.added_to(rows));
  const bool has_gradients = request == Request::values_and_gradients;
  Eigen::Index count = rows.over_cases.size();
  for (const CaseRows& one : rows.cases) count += std::ssize(one.places);
  Evaluation evaluation;
  evaluation.constraints.resize(count);
  if (has_gradients) evaluation.constraint_jacobian.resize(count, x.size());
  for (std::size_t c = 0; c < answers.size(); ++c) {
    const Evaluation& of_case = answers[c].evaluation;
    const std::vector<Eigen::Index>& places = rows.cases[c].places;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Eigen::Index row = i;
      evaluation.constraints(places[i]) = of_case.constraints(row);
      if (has_gradients) {
        evaluation.constraint_jacobian.row(places[i]) = of_case.constraint_jacobian.row(row);
      }
    }
  }
  Eigen::VectorXd gradient;
  Eigen::VectorXd* const wanted = has_gradients ? &gradient : nullptr;
  for (const RowOverCases& row : rows.over_cases) {
    evaluation.constraints(row.place) = row.sign * parts.combined(row.response, x, answers, wanted);
    if (has_gradients) evaluation.constraint_jacobian.row(row.place) = row.sign * gradient;
  }
  if (has_objective_in_cases()) {
    evaluation.objective = objective_of(answers, wanted);
  } else {
    evaluation.objective =
        objective_sign() * parts.combined(objective_response(), x, answers, wanted);
    gradient *= objective_sign();
  }
  if (has_gradients) evaluation.objective_gradient = gradient;
  return evaluation;
}

}  // namespace pleuel
