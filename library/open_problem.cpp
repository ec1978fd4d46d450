#include "library/open_problem.hpp"

#include <cmath>
#include <string_view>

#include "core/jobs/parallel.hpp"
#include "core/response/effect_measurement.hpp"
#include "core/response/history_reduction.hpp"
#include "core/scene/kind_table.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/problem_reader.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {

namespace {

ProblemFile read(const ProblemText& text, bool has_text) {
  UndecidedProblem problem = has_text ? read_problem_text(text.text, text.file, text.overrides)
                                      : read_problem(text.file, text.overrides);
  if (text.load_case.empty()) return decided(std::move(problem));
  return decided(UndecidedProblem(problem_of_case(problem.complete(), text.load_case)));
}

std::map<pleuel_list, std::vector<std::string>> names_in(const ProblemFile& file) {
  std::map<pleuel_list, std::vector<std::string>> names = {
      {PLEUEL_VARIABLES, names_of(file.variables)},
      {PLEUEL_RESPONSES, names_of(file.responses)},
      {PLEUEL_LIMITS, names_of(file.constraints)},
      {PLEUEL_BODIES, names_of(file.scene.bodies)},
      {PLEUEL_JOINTS, names_of(file.scene.joints)},
      {PLEUEL_CASES, {}},
      {PLEUEL_OBJECTIVE, {}}};
  for (const ProblemFile& one : file.cases) names[PLEUEL_CASES].push_back(one.load_case);
  if (file.objective) names[PLEUEL_OBJECTIVE].push_back(file.objective->response);
  return names;
}

std::string si_text(std::string_view unit) {
  return unit == "1" ? std::string() : std::string(unit);
}

std::map<pleuel_list, std::vector<std::string>> units_in(const ProblemFile& file) {
  std::map<pleuel_list, std::vector<std::string>> units;
  for (const ShownUnit& unit : variable_units(file)) {
    units[PLEUEL_VARIABLES].push_back(si_text(unit.si));
  }
  for (const ResponseSettings& response : file.responses) {
    units[PLEUEL_RESPONSES].push_back(si_text(quantity_of(response).unit));
  }
  for (const ConstraintSettings& constraint : file.constraints) {
    units[PLEUEL_LIMITS].push_back(si_text(unit_of(file, constraint).si));
  }
  if (file.objective) {
    const ResponseSettings& response = find_response(file, file.objective->response);
    units[PLEUEL_OBJECTIVE].push_back(si_text(quantity_of(response).unit));
  }
  return units;
}

/// Responses by themselves.
NamedRows response_rows(const ProblemFile& file) {
  NamedRows rows{"responses", {}};
  for (std::size_t i = 0; i < file.responses.size(); ++i) {
    rows.sources.push_back(response_row(file, i));
  }
  return rows;
}

Evaluation finite(Evaluation evaluation) {
  if (std::isfinite(evaluation.objective) && evaluation.constraints.allFinite() &&
      evaluation.objective_gradient.allFinite() && evaluation.constraint_jacobian.allFinite()) {
    return evaluation;
  }
  throw SimulationError("a value or a derivative at this design is not finite");
}

}  // namespace

OpenProblem::OpenProblem(const ProblemText& text, bool has_text)
    : file_name_(text.file),
      file_(read(text, has_text)),
      names_(names_in(file_)),
      units_(units_in(file_)) {}

const std::vector<std::string>& OpenProblem::names(pleuel_list list) const {
  if (const auto found = names_.find(list); found != names_.end()) return found->second;
  throw CallError(fmt::format("there is no list {}", list));
}

const std::vector<std::string>& OpenProblem::units(pleuel_list list) const {
  static const std::vector<std::string> none;
  const auto found = units_.find(list);
  return found == units_.end() ? none : found->second;
}

/// Responses need no objective, but a problem of optimization does: the first of them stands for it.
DesignProblem& OpenProblem::problem() {
  if (problem_) return *problem_;
  ProblemFile file = file_;
  if (!file.objective && !file.responses.empty()) {
    file.objective = Objective{file.responses.front().name};
  }
  problem_ = std::make_unique<DesignProblem>(std::move(file), available_threads());
  return *problem_;
}

Evaluation OpenProblem::evaluate(const Eigen::VectorXd& x, Request request) {
  if (!file_.objective) throw InputError("/objective is missing: there is nothing to minimize");
  const std::lock_guard lock(mutex_);
  return finite(problem().evaluate(x, request));
}

Evaluation OpenProblem::evaluate_responses(const Eigen::VectorXd& x, Request request) {
  const std::lock_guard lock(mutex_);
  return finite(problem().evaluate_rows(x, request, response_rows(file_)));
}

std::optional<OfCase> OpenProblem::place_of(std::size_t response) const {
  if (is_over_cases(file_, response)) return std::nullopt;
  return case_of_response(file_, response);
}

OpenProblem::Curve OpenProblem::history(const Eigen::VectorXd& x, std::size_t response) {
  const std::optional<OfCase> place = place_of(response);
  if (!place) return {};
  const std::lock_guard lock(mutex_);
  const Analysis& analysis = problem().load_case(place->load_case).analysis_at(x);
  const Response& one = analysis.responses[place->index];
  if (!one.history()) return {};
  return {analysis.trajectory.time, shown_history(one, analysis.histories[place->index])};
}

std::optional<HistoryGradients> OpenProblem::history_gradients(const Eigen::VectorXd& x,
                                                               std::size_t response) {
  const std::optional<OfCase> place = place_of(response);
  if (!place) return std::nullopt;
  const std::lock_guard lock(mutex_);
  if (!differentiated_.empty() && differentiated_x_ != x) differentiated_.clear();
  differentiated_x_ = x;
  auto found = differentiated_.find(place->load_case);
  if (found == differentiated_.end()) {
    Analysis& analysis =
        problem().load_case(place->load_case).analysis_at(x, Request::values_and_gradients);
    found = differentiated_.emplace(place->load_case, pleuel::history_gradients(analysis)).first;
  }
  for (const HistoryGradients& one : found->second) {
    if (one.response == place->index) return one;
  }
  return std::nullopt;
}

namespace {

/// Never destroyed: threads of the caller may outlive what the program ends with.
HandleTable<OpenProblem>& table() {
  static auto& one = *new HandleTable<OpenProblem>(
      "the problem {} is not open: it was closed, or never came from pleuel_open");
  return one;
}

}  // namespace

pleuel_problem add_open_problem(std::shared_ptr<OpenProblem> problem) {
  return table().add(std::move(problem));
}

std::shared_ptr<OpenProblem> find_open_problem(pleuel_problem number) {
  return table().find(number);
}

void remove_open_problem(pleuel_problem number) {
  table().remove(number);
}

}  // namespace pleuel
