#include "cli/files/history_csv.hpp"

namespace pleuel {

namespace {

std::vector<std::string> header(const Problem& problem) {
  std::vector<std::string> titles = {"evaluation", "iteration",     "seconds", "purpose",
                                     "request",    "max_violation", "step",    "objective"};
  for (const Constraint& constraint : problem.constraints()) {
    titles.push_back("constraint:" + constraint.name);
  }
  for (const Variable& variable : problem.variables()) {
    titles.push_back("variable:" + variable.name);
  }
  titles.insert(titles.end(), {"time_step", "elements", "failure"});
  return titles;
}

}  // namespace

std::string to_string(Request request) {
  return request == Request::values ? "values" : "gradients";
}

HistoryCsv::HistoryCsv(const ResultFile& file, const DesignProblem& problem)
    : constraints_(problem.constraints().size()),
      objective_sign_(problem.objective_sign()),
      csv_(file, header(problem)) {}

void HistoryCsv::add(const EvaluationRecord& record) {
  const bool has_failed = record.has_failed();
  const auto add_value = [&](double value) {
    has_failed ? csv_.add(std::string()) : csv_.add(value);
  };
  csv_.add(record.evaluation).add(record.iteration).add(record.seconds);
  csv_.add(to_string(record.purpose)).add(to_string(record.request));
  add_value(record.max_violation);
  csv_.add(record.step);
  add_value(objective_sign_ * record.objective);
  for (std::size_t i = 0; i < constraints_; ++i) {
    add_value(has_failed ? 0.0 : record.constraints(i));
  }
  for (const double value : record.x) csv_.add(value);
  csv_.add(record.time_step).add(record.elements).add(record.failure);
  csv_.end_row();
}

}  // namespace pleuel
