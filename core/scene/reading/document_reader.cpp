#include "core/scene/reading/document_reader.hpp"

#include <fmt/format.h>

#include "core/base/machine_memory.hpp"
#include "core/scene/reading/case_suffix.hpp"
#include "core/scene/reading/catalogue.hpp"
#include "core/scene/reading/goal_reader.hpp"
#include "core/scene/reading/mistakes.hpp"
#include "core/scene/reading/override.hpp"
#include "core/scene/reading/response_reader.hpp"
#include "core/scene/reading/scene_check.hpp"
#include "core/scene/reading/scene_reader.hpp"
#include "core/scene/reading/settings_reader.hpp"
#include "core/scene/scene_rules.hpp"

namespace pleuel {
namespace {

void read_heading(const JsonNode& root, ProblemFile& problem) {
  std::vector<std::string_view> keys = {
      "$schema",     "name",      "description", "scene",       "effects",   "simulation",
      "sensitivity", "constants", "variables",   "responses",   "objective", "constraints",
      "optimizer",   "pareto",    "accuracy",    "uncertainty", "cases"};  // expanded before
  if (const auto of_case = root.find(case_key)) {
    keys.push_back(case_key);
    const std::vector<JsonNode> names = of_case->items(2);
    problem.load_case = names[0].text();
    if (names[1].value() != "") problem.case_range = names[1].text();
  }
  root.allow_keys(keys);
  if (const auto schema = root.find("$schema")) schema->text();
  if (const auto name = root.find("name")) problem.name = name->text();
  if (const auto description = root.find("description")) problem.description = description->text();
}

void read_settings(const JsonNode& root, NumberReader& numbers, ProblemFile& problem) {
  problem.sensitivity.memory = default_memory();
  MistakeCollector mistakes;
  const auto read = [&](const char* key, const auto& read_block) {
    mistakes.collect([&] {
      if (const auto node = root.find(key)) read_block(*node);
    });
  };
  read("effects", [&](const JsonNode& node) { read_keys(node, numbers, problem.effects); });
  read("sensitivity", [&](const JsonNode& node) { read_keys(node, numbers, problem.sensitivity); });
  read("optimizer", [&](const JsonNode& node) {
    problem.optimizer = read_optimizer(node, problem.variables, numbers);
  });
  read("pareto", [&](const JsonNode& node) {
    numbers.read_or_leave_out("pareto",
                              [&] { problem.pareto = read_pareto(node, problem, numbers); });
  });
  read("accuracy", [&](const JsonNode& node) {
    problem.accuracy = read_accuracy(node, problem.responses, numbers);
  });
  read("uncertainty", [&](const JsonNode& node) {
    problem.uncertainty = read_uncertainty(node, numbers, problem.variables);
  });
  mistakes.fail_if_any();
}

void check_scattering_places(const JsonNode& root, const ProblemFile& problem) {
  if (!problem.uncertainty) return;
  const Design<double> start = start_values(problem.variables);
  for (const UncertainParameter& parameter : problem.uncertainty->parameters) {
    const auto moved =
        find_point_moved_along(problem.scene, start, parameter.variable, parameter.half_width());
    if (!moved) continue;
    const std::string& name = problem.variables[parameter.variable].name;
    root.at("uncertainty").at("parameters").at(name).fail(*moved);
  }
}

void check_margins(const JsonNode& root, const ProblemFile& problem) {
  for (const ConstraintSettings& constraint : problem.constraints) {
    if (constraint.deviations == 0.0 || problem.uncertainty) continue;
    root.at("constraints")
        .at(constraint.name)
        .at("deviations")
        .fail("needs the block \"uncertainty\", which says what scatters");
  }
}

}  // namespace

Json overridden_document(const ProblemText& text) {
  Json document = parse_json(text.text, text.file);
  for (const std::string& assignment : text.overrides) {
    apply_override(document, assignment, text.file);
  }
  if (text.load_case.empty()) return document;
  for (const CaseChanges& changes : cases_of(document, text.file)) {
    if (changes.name == text.load_case) return document_of_case(document, changes, text.file);
  }
  throw InputError(fmt::format("{}: /cases has no case \"{}\"", text.file, text.load_case));
}

std::vector<CaseChanges> cases_of(const Json& document, const std::string& file) {
  return read_cases(JsonNode(document, file));
}

Json whole_document(const ProblemText& text) {
  Json document = overridden_document(text);
  expand_names(document, text.file);
  return document;
}

/// The variables come late: where they are used tells what they measure. What follows from a part
/// with mistakes is not read.
ProblemFile read_document(const JsonNode& root, NumberReader& numbers) {
  ProblemFile problem;
  MistakeCollector mistakes;
  mistakes.collect([&] { read_heading(root, problem); });
  numbers.declare(root);
  mistakes.collect([&] { problem.scene = read_scene(root.at("scene"), numbers); });
  mistakes.collect([&] { problem.simulation = read_simulation(root.at("simulation"), numbers); });
  mistakes.fail_if_any();
  if (const auto responses = root.find("responses")) {
    problem.responses = read_responses(*responses, problem.scene, problem.simulation, numbers);
  }
  mistakes.collect([&] {
    if (const auto objective = root.find("objective")) {
      numbers.read_or_leave_out("objective", [&] {
        problem.objective = read_objective(*objective, problem.responses, numbers);
      });
    }
  });
  mistakes.collect([&] {
    if (const auto constraints = root.find("constraints")) {
      problem.constraints = read_constraints(*constraints, problem.responses, numbers);
    }
  });
  mistakes.fail_if_any();
  if (const auto variables = root.find("variables")) {
    problem.variables = read_variables(*variables, numbers);
  }
  problem.scene.formulas = numbers.ranged_formulas();
  read_settings(root, numbers, problem);
  check_margins(root, problem);
  check_scene(root.at("scene"), problem);
  check_scattering_places(root, problem);
  if (const auto effects = root.find("effects")) check_effects(*effects, problem);
  return problem;
}

}  // namespace pleuel
