#include <variant>

#include "cli/reports/accuracy_report.hpp"
#include "cli/reports/outcome.hpp"
#include "cli/reports/setting_report.hpp"
#include "cli/reports/time_text.hpp"
#include "cli/reports/warnings.hpp"
#include "core/trust/checks.hpp"

namespace pleuel {

namespace {

Json of_responses(const ProblemFile& problem, const Eigen::VectorXd& numbers) {
  return by_name(problem.responses, numbers);
}

/// What is known of a run that succeeded.
void add_measures(const ProblemFile& problem, const AccuracyRun& run, Json& document) {
  document["errors"] = of_responses(problem, run.errors);
  document["gradient_errors"] = of_responses(problem, run.gradient_errors);
  document["optimum_error"] = number_or_null(run.optimum_change);
  document["seconds"] = run.seconds();
  document["simulation_seconds"] = run.simulation_seconds;
  document["gradient_seconds"] = run.gradient_seconds;
  document["work"] = {{"steps", run.steps},
                      {"newton_iterations", run.newton_iterations},
                      {"factorizations", run.factorizations}};
}

/// Of the setting, and of what is changed of it.
Json varied_overrides(const ProblemInput& input, const AccuracyRun& base,
                      const Variation& variation) {
  Json overrides = overrides_document(input, base.settings);
  for (const Override& one : variation.overrides) {
    std::visit([&](const auto& value) { overrides[one.pointer] = value; }, one.value);
  }
  return overrides;
}

/// What changed; the failure of a run that did, else what `measures` adds, and how its time changed:
/// `time_change` is null where nothing can be said of it.
Json variation_document(const char* key, const ProblemInput& input, const AccuracyRun& base,
                        const VariedRun& varied, const std::function<void(Json&)>& measures) {
  Json document = {{key, varied.variation.knob},
                   {"value", varied.variation.value},
                   {"overrides", varied_overrides(input, base, varied.variation)}};
  if (varied.run.has_failed()) {
    document["failure"] = varied.run.failure;
    return document;
  }
  measures(document);
  const ComparedTime& time = varied.time;
  const bool is_known = is_same(time) || time.is_measurable();
  document["time_change"] = is_known ? Json(time.change) : Json(nullptr);
  document["time"] = time_change_document(time);
  return document;
}

/// What is recommended for values, or for values and gradients; null if nothing is.
Json choice_document(const ProblemInput& input, const AccuracyStudy& study,
                     const std::optional<std::size_t>& choice, double AccuracyRun::*more_seconds) {
  if (!choice) return nullptr;
  const AccuracyRun& run = study.runs[*choice];
  Json document = settings_document(run.settings);
  document["overrides"] = overrides_document(input, run.settings);
  document["seconds"] = run.simulation_seconds + (more_seconds ? run.*more_seconds : 0.0);
  document["errors"] = of_responses(input.problem, run.errors);
  return document;
}

Json reference_document(const ProblemFile& problem, const AccuracyStudy& study) {
  const AccuracyRun& reference = study.reference;
  Json document = settings_document(reference.settings);
  document["seconds"] = reference.seconds();
  document["values"] = of_responses(problem, reference.values);
  document["errors"] = of_responses(problem, reference.errors);
  document["gradient_errors"] = of_responses(problem, reference.gradient_errors);
  document["check"] = {{"formulation", study.check.formulation}};
  if (study.check.failure.empty()) {
    document["check"]["differences"] = of_responses(problem, study.check.differences);
  } else {
    document["check"]["failure"] = study.check.failure;
  }
  return document;
}

void add_recommendations(const ProblemInput& input, const AccuracyStudy& study, Json& document) {
  document["recommended"] = document["recommended_for_gradients"] = nullptr;
  document["recommendations"] = list_of(study.recommendations, [&](const Recommendation& one) {
    const auto with_gradients = &AccuracyRun::gradient_seconds;
    return Json{{"error", one.target},
                {"values", choice_document(input, study, one.values, nullptr)},
                {"gradients", choice_document(input, study, one.gradients, with_gradients)}};
  });
  if (study.recommendations.empty()) return;
  document["recommended"] = document["recommendations"][0]["values"];
  document["recommended_for_gradients"] = document["recommendations"][0]["gradients"];
}

void add_variations(const ProblemInput& input, const AccuracyStudy& study, Json& document) {
  document["base"] = nullptr;
  document["knobs"] = document["effects"] = Json::array();
  if (!study.base) return;
  const AccuracyRun& base = study.runs[*study.base];
  document["base"] = settings_document(base.settings);
  document["knobs"] = list_of(study.knobs, [&](const VariedRun& one) {
    return variation_document("knob", input, base, one,
                              [&](Json& knob) { add_measures(input.problem, one.run, knob); });
  });
  document["effects"] = list_of(study.effects, [&](const VariedRun& one) {
    return variation_document("effect", input, base, one, [&](Json& effect) {
      effect["influence"] = of_responses(input.problem, one.influence);
      effect["optimum_change"] = number_or_null(one.run.optimum_change);
      effect["seconds"] = one.run.simulation_seconds;
    });
  });
}

Json optimum_document(const ProblemInput& input, const OptimumStudy& optima,
                      const OptimumRun& run) {
  Json document = {{"settings", settings_document(run.settings)},
                   {"overrides", overrides_document(input, run.settings)},
                   {"status", to_string(run.status)},
                   {"seconds", run.seconds},
                   {"evaluations", run.evaluations}};
  if (run.has_failed()) {
    document["failure"] = run.failure;
    return document;
  }
  document["objective"] = run.objective;
  document["error"] = run.change;
  document["relative_error"] = optima.relative_error(run);
  document["variables"] = by_name(input.problem.variables, run.x);
  return document;
}

}  // namespace

void add_optima(const ProblemInput& input, const OptimumStudy& optima, Json& document) {
  document["optimum"] = list_of(
      optima.runs, [&](const OptimumRun& run) { return optimum_document(input, optima, run); });
  document["optimum_reference"] = optimum_document(input, optima, optima.reference);
  document["optimum_reference"]["error"] = number_or_null(optima.reference_error);
  document["optimum_reference"]["relative_error"] =
      optima.reference_error ? Json(optima.relative_floor()) : Json(nullptr);
}

std::vector<std::string> warnings_of(const AccuracyStudy& study) {
  std::vector<std::string> warnings = texts_of(study.reference.findings);
  if (!study.recommendations.empty() && study.recommendations.front().values) {
    add_new(warnings, texts_of(study.runs[*study.recommendations.front().values].findings));
  }
  if (!study.failure.empty()) {
    warnings.push_back("other knobs and effects are not known: " + study.failure);
  }
  return warnings;
}

Json settings_document(const Discretization& settings) {
  Json document = {{"step", settings.step}};
  if (settings.elements > 0) {
    document["elements"] = settings.elements;
  } else {
    document["element_factor"] = settings.factor;
  }
  return document;
}

Json run_document(const ProblemFile& problem, const AccuracyRun& run) {
  Json document = {{"settings", settings_document(run.settings)}};
  if (run.has_failed()) {
    document["failure"] = run.failure;
    return document;
  }
  document["warnings"] = texts_of(run.findings);
  add_measures(problem, run, document);
  return document;
}

Json overrides_document(const ProblemInput& input, const Discretization& settings) {
  return overrides_document(input.effective, discretized(input.problem, settings));
}

Json accuracy_document(const ProblemInput& input, const AccuracyStudy& study) {
  const ProblemFile& problem = input.problem;
  const auto name_of = [&](std::size_t response) { return problem.responses[response].name; };
  const auto entry_of = [&](const AccuracyRun& run) { return run_document(problem, run); };
  Json document = {{"status", study_status(!study.is_interrupted)},
                   {"error", problem.accuracy.target},
                   {"counted", list_of(study.counted, name_of)},
                   {"runs", list_of(study.runs, entry_of)}};
  add_recommendations(input, study, document);
  add_variations(input, study, document);
  document["orders"] = {
      {"values", number_or_null(fitted_order(study, &AccuracyRun::errors))},
      {"gradients", number_or_null(fitted_order(study, &AccuracyRun::gradient_errors))}};
  document["reference"] = reference_document(problem, study);
  document["warnings"] = warnings_of(study);
  return document;
}

}  // namespace pleuel
