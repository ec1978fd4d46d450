#include "cli/reports/optimum_document.hpp"

#include <cmath>

#include <fmt/format.h>

#include "cli/reports/case_report.hpp"
#include "cli/reports/limits_report.hpp"
#include "cli/reports/scene_report.hpp"
#include "cli/reports/starts_report.hpp"
#include "core/base/number_text.hpp"
#include "core/scene/case_goals.hpp"

namespace pleuel {

namespace {

/// "is lighter", "has a smaller rod_bow"
std::string better_text(const ProblemFile& problem) {
  const ResponseSettings& response = find_response(problem, problem.objective->response);
  const bool is_minimized = problem.objective->sign() > 0.0;
  if (quantity_of(response).unit == "kg") return is_minimized ? "is lighter" : "is heavier";
  return fmt::format("has a {} {}", is_minimized ? "smaller" : "larger", response.name);
}

std::string accuracy_text(const Optimum& optimum) {
  const std::string& name = optimum.problem.objective->response;
  const double value = optimum.result.evaluation.objective;
  if (!optimum.result.error || !optimum.result.error->is_resolved() || value == 0.0) {
    return "how exact the simulation is was not looked at";
  }
  const double bound = optimum.result.error->bound();
  if (bound == 0.0) return fmt::format("{} is exact", name);
  return fmt::format("steps and elements change {} by {} % at most", name,
                     significant(100.0 * bound / std::abs(value), 2));
}

Json objective_document(const Optimum& optimum) {
  const std::string& name = optimum.problem.objective->response;
  Json document = {{"name", name}, {"unit", unit_of(find_response(optimum.problem, name)).si}};
  if (!optimum.has_design()) return document;
  const double sign = optimum.problem.objective->sign();
  document["value"] = sign * optimum.result.evaluation.objective;
  document["start"] = sign * first_design(optimum.result.history).objective;
  if (optimum.result.error) document["error"] = error_document(optimum.result.error);
  return document;
}

Json constraint_document(const Optimum& optimum, std::size_t i) {
  const ConstraintSettings& constraint = optimum.problem.constraints[i];
  Json document =
      limit_entry(optimum.problem, constraint, optimum.result.evaluation.constraints(i));
  if (has_prices(optimum.result)) {
    document["multiplier"] =
        optimum.problem.objective->sign() * optimum.result.constraint_multipliers(i);
  }
  if (constraint.deviations > 0.0) document["deviations"] = constraint.deviations;
  const std::string load_case = case_of(optimum.problem, i);
  if (!load_case.empty()) {
    document["limit_name"] = limit_name(optimum.problem, i);
    document["case"] = load_case;
    document["decides"] =
        bool(deciding_constraints(optimum.problem, optimum.result.evaluation.constraints)[i]);
  }
  return document;
}

Json responses_document(const Optimum& optimum) {
  Json document = Json::object();
  for (std::size_t i = 0; i < optimum.problem.responses.size(); ++i) {
    const ResponseSettings& response = optimum.problem.responses[i];
    document[response.name] = {{"value", optimum.responses(i)},
                               {"unit", quantity_of(response).unit},
                               {"start", optimum.start_responses(i)}};
    const ErrorBars& errors = optimum.result.response_errors;
    if (!errors.empty()) document[response.name]["error"] = error_document(error_of(errors, i));
    if (optimum.gradients.size() > 0) {
      document[response.name]["gradients"] =
          by_name(optimum.problem.variables, optimum.gradients.row(i));
    }
  }
  return document;
}

Json search_part_document(const SearchPart& part) {
  return {{"method", part.method},
          {"status", to_string(part.status)},
          {"evaluations", part.evaluations}};
}

Json least_violation_document(const ProblemFile& problem, const LeastViolation& least) {
  Json limits = Json::object();
  for (const ExceededLimit& one : least.limits) {
    const ConstraintSettings& constraint = problem.constraints[one.constraint];
    Json limit = {{"limit", one.limit},
                  {"side", one.is_upper ? "upper" : "lower"},
                  {"unit", unit_of(problem, constraint).si},
                  {"in_conflict", one.is_in_conflict},
                  {"together", one.together}};
    if (one.alone) limit["alone"] = *one.alone;
    limits[constraint.name] = std::move(limit);
  }
  return {{"violation", least.violation}, {"proven", least.is_proven}, {"limits", limits}};
}

}  // namespace

std::string neighbours_text(const Optimum& optimum) {
  const std::string better = better_text(optimum.problem);
  if (optimum.sizes == nullptr || !optimum.sizes->is_choice) {
    return fmt::format("no design nearby that keeps them {}", better);
  }
  const SizeChoiceReport& sizes = *optimum.sizes;
  if (sizes.is_exhaustive) {
    return fmt::format(
        "of all {:.0f} choices of sizes, which were all tried, none that keeps them {}",
        sizes.combinations, better);
  }
  return fmt::format(
      "of the {} choices of sizes that were tried none that keeps them {}, also with any one size "
      "exchanged for {}; the others were not tried",
      sizes.tried, better, sizes.are_lists_tried ? "another" : "the next");
}

std::string plain_verdict(const Optimum& optimum) {
  if (optimum.result.status != Status::verified) return "";
  return fmt::format(
      "every limit holds; {}; the gradients agree with differences of simulations; {}",
      neighbours_text(optimum), accuracy_text(optimum));
}

Json optimum_document(const Optimum& optimum) {
  const Result& result = optimum.result;
  Json document = {{"status", to_string(result.status)},
                   {"message", result.message},
                   {"backend", result.backend},
                   {"objective", objective_document(optimum)},
                   {"variables", variables_document(optimum.problem, result.x)},
                   {"constraints", Json::object()}};
  const std::string plain = plain_verdict(optimum);
  if (!plain.empty()) document["checked"] = plain;
  for (std::size_t i = 0; i < optimum.problem.variables.size(); ++i) {
    document["variables"][optimum.problem.variables[i].name]["start"] = optimum.start(i);
  }
  if (optimum.has_design()) {
    for (std::size_t i = 0; i < optimum.problem.constraints.size(); ++i) {
      document["constraints"][optimum.problem.constraints[i].name] =
          constraint_document(optimum, i);
    }
    if (optimum.responses.size() > 0) document["responses"] = responses_document(optimum);
    document["monitors"] = monitors_document(optimum.monitors);
    document["warnings"] = optimum.warnings;
  }
  document["kkt_residual"] = result.kkt_residual;
  document["max_violation"] = result.max_violation;
  document["evaluations"] = result.evaluations;
  document["failed_evaluations"] = count_failures(result.history);
  document["gradient_evaluations"] = result.gradient_evaluations;
  document["iterations"] = result.iterations;
  document["restarts"] = result.restarts;
  if (optimum.problem.has_cases()) {
    document["cases"] = cases_document(optimum.problem, result);
  }
  if (result.parts.size() > 1) document["parts"] = list_of(result.parts, search_part_document);
  if (result.least_violation) {
    document["least_violation"] =
        least_violation_document(optimum.problem, *result.least_violation);
  }
  if (!result.polished_with.empty()) document["polished_with"] = result.polished_with;
  if (optimum.method) {
    document["gradients"] = {{"method", to_string(optimum.method->method)},
                             {"reason", optimum.method->reason}};
  }
  document["seconds"] = result.seconds;
  return document;
}

Optimum optimum_of(const WholeSearch& search) {
  const Result& result = search.all.best.result;
  const DesignProblem& problem = *search.all.best.problem;
  Optimum optimum{problem.file(),      result,          {}, {}, {}, result.warnings,
                  result.consequences, problem.method()};
  if (search.sizes) optimum.sizes = &*search.sizes;
  return optimum;
}

void add_search(const WholeSearch& search, Json& document) {
  const ProblemFile& problem = search.all.best.problem->file();
  if (search.all.runs.size() > 1) document["starts"] = starts_document(problem, search.all);
  if (!search.sizes) return;
  document["choices"] = sizes_document(problem, *search.sizes, search.all.best.result);
}

}  // namespace pleuel
