#include "optimization/design/design_problem.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/jobs/parallel.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/response_parts.hpp"

namespace pleuel {

RowSource response_row(const ProblemFile& joined, std::size_t response, double sign) {
  const OfCase of_case = case_of_response(joined, response);
  if (is_of_several(of_case)) return {.sign = sign, .over_cases = response};
  return {.load_case = of_case.load_case, .part = of_case.index, .sign = sign};
}

namespace {

/// Rows that each case is asked for.
using RowsOfCases = std::vector<std::vector<RowSource>>;

/// What responses over cases are made from, as further rows of the cases: asked for behind their
/// own, and put together when all are known.
class PartRows {
 public:
  /// @param responses  over cases, or of one case, by their places in the joined problem
  PartRows(const ProblemFile& joined, const std::vector<std::size_t>& responses) : joined_(joined) {
    std::set<std::size_t> parts;
    for (const std::size_t response : responses) {
      for (const std::size_t part : parts_in_cases(joined, response)) parts.insert(part);
    }
    std::map<std::size_t, Eigen::Index> counts;
    for (auto part = parts.rbegin(); part != parts.rend(); ++part) {
      from_end_[*part] = ++counts[case_of_response(joined, *part).load_case];
    }
  }

  /// Adds the rows of the parts behind others, and to their name.
  void add_to(RowsOfCases& rows, std::string& name) const {
    if (from_end_.empty()) return;
    name += ", with";
    for (const auto& [part, place] : from_end_) {
      const RowSource source = response_row(joined_, part);
      rows[source.load_case].push_back(source);
      name += fmt::format(" {}", joined_.responses[part].name);
    }
  }

  /// Value of one of the responses, and its gradient where it is asked for.
  /// @param answers   one a case, to the rows of add_to()
  /// @param gradient  may be null
  double combined(std::size_t response, const Eigen::VectorXd& x,
                  const std::vector<StoredEvaluation>& answers, Eigen::VectorXd* gradient) const {
    const auto row_of = [&](std::size_t part, const Evaluation& evaluation) {
      return evaluation.constraints.size() - from_end_.at(part);
    };
    const auto evaluation_of = [&](std::size_t part) -> const Evaluation& {
      return answers[case_of_response(joined_, part).load_case].evaluation;
    };
    const ValueInCase value_of = [&](std::size_t part) {
      const Evaluation& evaluation = evaluation_of(part);
      return evaluation.constraints(row_of(part, evaluation));
    };
    if (gradient != nullptr) {
      const LinearizedResponse linear = linearized_over_cases(joined_, response, x, value_of);
      *gradient = linear.design;
      for (const WeightedResponse& part : linear.parts) {
        const Evaluation& evaluation = evaluation_of(part.response);
        *gradient +=
            part.weight *
            evaluation.constraint_jacobian.row(row_of(part.response, evaluation)).transpose();
      }
    }
    return value_over_cases(joined_, response, x, value_of);
  }

 private:
  const ProblemFile& joined_;
  /// Each part by its place in the joined problem: the number of its row, counted from the last of
  /// its case.
  std::map<std::size_t, Eigen::Index> from_end_;
};

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
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    const OfCase of_case = case_of_constraint(file_, i);
    // As one over cases whatever it is made of: PartRows name its parts, by which records tell rows apart.
    rows.sources.push_back(is_of_several(of_case)
                               ? RowSource{.sign = 1.0, .over_cases = response_of(i)}
                               : RowSource{of_case.load_case, of_case.index});
  }
  return evaluate_rows(x, request, rows);
}

/// The store belongs to this process and is asked and told in the order of the cases: what it holds
/// and what comes of it does not depend on how many run at a time.
std::vector<StoredEvaluation> DesignProblem::answers_of(
    const Eigen::VectorXd& x, Request request, const std::string& name,
    const std::vector<std::vector<RowSource>>& rows) {
  std::vector<StoredEvaluation> answers(case_count());
  std::vector<std::size_t> open;
  for (std::size_t c = 0; c < case_count(); ++c) {
    if (auto known = cases_[c]->recall(x, request, name, rows[c])) {
      answers[c] = std::move(*known);
    } else {
      open.push_back(c);
    }
  }
  for_each_in_parallel(int_size(open), threads_, [&](int i) {
    answers[open[i]] = cases_[open[i]]->compute(x, request, rows[open[i]]);
  });
  for (const std::size_t c : open) cases_[c]->keep(answers[c]);
  for (std::size_t c = 0; c < case_count(); ++c) {
    const std::string& failure = answers[c].failure;
    if (failure.empty()) continue;
    throw SimulationError(file_.has_cases() ? fmt::format("in the case \"{}\": {}",
                                                          cases_[c]->file().load_case, failure)
                                            : failure);
  }
  return answers;
}

double DesignProblem::objective_of(const std::vector<StoredEvaluation>& answers,
                                   Eigen::VectorXd* gradient) const {
  if (minimizes_worst()) {
    const auto worst = std::ranges::max_element(
        answers, {}, [](const StoredEvaluation& one) { return one.evaluation.objective; });
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

Evaluation DesignProblem::evaluate_rows(const Eigen::VectorXd& x, Request request,
                                        const NamedRows& rows) {
  RowsOfCases asked(case_count());
  Eigen::Index count = 0;
  std::vector<std::size_t> over_cases;
  if (!has_objective_in_cases()) over_cases.push_back(objective_response());
  for (const RowSource& source : rows.sources) {
    count += source.count();
    if (source.over_cases) {
      over_cases.push_back(*source.over_cases);
    } else {
      asked[source.load_case].push_back(source);
    }
  }
  const PartRows parts(file_, over_cases);
  std::string name = rows.name;
  parts.add_to(asked, name);
  const std::vector<StoredEvaluation> answers = answers_of(x, request, name, asked);

  const bool has_gradients = request == Request::values_and_gradients;
  Eigen::VectorXd gradient;
  Eigen::VectorXd* const wanted = has_gradients ? &gradient : nullptr;
  Evaluation evaluation;
  if (has_objective_in_cases()) {
    evaluation.objective = objective_of(answers, wanted);
  } else {
    evaluation.objective =
        objective_sign() * parts.combined(objective_response(), x, answers, wanted);
    gradient *= objective_sign();
  }
  evaluation.objective_gradient = gradient;
  evaluation.constraints.resize(count);
  if (has_gradients) evaluation.constraint_jacobian.resize(count, x.size());
  std::vector<Eigen::Index> next(case_count(), 0);
  Eigen::Index row = 0;
  for (const RowSource& source : rows.sources) {
    const Eigen::Index size = source.count();
    if (source.over_cases) {
      const double sign = *source.sign;
      evaluation.constraints(row) = sign * parts.combined(*source.over_cases, x, answers, wanted);
      if (has_gradients) evaluation.constraint_jacobian.row(row) = sign * gradient;
    } else {
      const Evaluation& of_case = answers[source.load_case].evaluation;
      const Eigen::Index first =
          std::exchange(next[source.load_case], next[source.load_case] + size);
      evaluation.constraints.segment(row, size) = of_case.constraints.segment(first, size);
      if (has_gradients) {
        evaluation.constraint_jacobian.middleRows(row, size) =
            of_case.constraint_jacobian.middleRows(first, size);
      }
    }
    row += size;
  }
  return evaluation;
}

}  // namespace pleuel
