#include "cli/input/problem_input.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "cli/input/fingerprint.hpp"
#include "cli/text/console.hpp"
#include "core/base/error.hpp"
#include "core/response/effect_measurement.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/reading/document_reader.hpp"
#include "core/scene/reading/override.hpp"
#include "core/scene/reading/syntax_error.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {

namespace {

void check_names(const JsonNode& variables, const ProblemFile& problem) {
  const std::vector<std::string> known = list_of(problem.variables, &DesignVariable::name);
  for (const auto& [name, member] : variables.members()) {
    if (std::ranges::find(known, name) != known.end()) continue;
    fail_unknown_name(variables, "design variable", name, known);
  }
}

/// A number in the unit that stands beside it, by default SI ("1" of a pure number); or a text with
/// unit.
double read_number(const std::optional<JsonNode>& unit, const JsonNode& value,
                   const Quantity& quantity) {
  const JsonNode& written = value.value().is_string() || !unit ? value : *unit;
  try {
    if (value.value().is_string()) return read_quantity(value.text(), quantity);
    const bool is_si = !unit || unit->text() == quantity.unit;
    return value.number() * (is_si ? 1.0 : unit_scale(unit->text(), quantity));
  } catch (const UnitError& error) {
    written.fail_with_value("must be " + describe(quantity), fmt::format(": {}", error.what()));
  }
}

/// {"value", "unit"}, or the value alone.
double read_value(const JsonNode& node, const DesignVariable& variable) {
  const JsonNode value = node.value().is_object() ? node.at("value") : node;
  for (const SizeChoice& choice : variable.choices) {
    if (value.value().is_string() && value.text() == choice.text) return choice.value;
  }
  const auto unit = node.value().is_object() ? node.find("unit") : std::nullopt;
  const double x = read_number(unit, value, variable.quantity);
  if (x < variable.lower || x > variable.upper) {
    value.fail_with_value("must lie within the bounds of " + bounds_text(variable),
                          value.value().is_number() && !unit ? " in SI units" : "");
  }
  return x;
}

/// The member "variables" of what a command has written, or the whole document.
JsonNode variables_of(const JsonNode& root) {
  const bool is_result = root.find("variables") || root.find("status");
  return is_result ? root.at("variables") : root;
}

/// Index 3 without numerical damping is unstable: the multipliers swing ever more, and nothing in a
/// short simulation shows it.
void note_unstable_scheme(const ProblemInput& input) {
  const std::vector<const ProblemFile*> problems = simulated_problems(input.problem);
  const bool is_unstable = std::ranges::any_of(problems, [](const ProblemFile* problem) {
    const SimulationSettings& settings = problem->simulation;
    return settings.scheme != SchemeType::implicit_euler && settings.spectral_radius >= 1.0 &&
           settings.formulation.constraints == ConstraintForm::index_3;
  });
  if (!is_unstable) return;
  show(stderr,
       fmt::format("{}: note: with the spectral radius 1 the forces in joints are unstable in the "
                   "formulation \"index-3\"; take a radius below 1, or \"stabilized-index-2\"\n",
                   input.file.string()));
}

/// Values of variables that are called by their names stand above those of a file with a design.
void apply_named_values(const Arguments& arguments, const ProblemFile& problem,
                        Eigen::VectorXd& x) {
  for (const std::string& assignment : arguments.overrides) {
    const std::string name = assigned_place(assignment);
    if (name.starts_with("/")) continue;
    for (std::size_t i = 0; i < problem.variables.size(); ++i) {
      if (problem.variables[i].name != name) continue;
      x(i) = problem.variables[i].start;
    }
  }
}

void set_method(SensitivitySettings& sensitivity, const Arguments& arguments) {
  if (!arguments.methods.empty()) sensitivity.method = gradient_method(arguments.methods.front());
  if (arguments.difference_step) sensitivity.difference_step = *arguments.difference_step;
}

/// Optimizations look at all cases together.
void require_one_case(const ProblemFile& problem, const fs::path& file,
                      const Arguments& arguments) {
  const bool takes_all = arguments.command == "optimize" || arguments.command == "pareto";
  if (!problem.has_cases() || takes_all) return;
  throw InputError(fmt::format(
      "{}: has the load cases {}; `pleuel {}` takes one of them: --case \"{}\"", file.string(),
      case_list(problem), arguments.command, problem.cases.front().load_case));
}

UndecidedProblem read_asked_case(const fs::path& file, const Arguments& arguments) {
  UndecidedProblem read = read_problem(file, arguments.overrides);
  if (arguments.load_case) {
    return UndecidedProblem(problem_of_case(read.complete(), *arguments.load_case));
  }
  require_one_case(read.complete(), file, arguments);
  return read;
}

/// Of a start design that cannot be built it is told where that is simulated.
void require_room_for_instants(const ProblemFile& problem) {
  for (const ProblemFile* one : simulated_problems(problem)) {
    try {
      require_memory(*one);
    } catch (const SimulationError&) {
    }
  }
}

ProblemInput read_file(const fs::path& file, const Arguments& arguments) {
  ProblemInput input;
  input.file = file;
  UndecidedProblem read = read_asked_case(file, arguments);
  input.design = design_of(arguments, read.complete());
  input.design_name = arguments.design ? "design" : "start";
  input.problem = decided(std::move(read));
  set_method(input.problem.sensitivity, arguments);
  for (ProblemFile& one : input.problem.cases) set_method(one.sensitivity, arguments);
  input.text = {whole_text(file), file.string(), arguments.overrides,
                arguments.load_case.value_or("")};
  input.effective = overridden_document(input.text);
  Fingerprint fingerprint;
  fingerprint.add(input.text.text);
  for (const std::string& assignment : arguments.overrides) fingerprint.add(assignment);
  if (arguments.load_case) fingerprint.add(*arguments.load_case);
  if (arguments.design) {
    const bool is_folder = fs::is_directory(*arguments.design);
    fingerprint.add(whole_text(is_folder ? *arguments.design / "result.json" : *arguments.design));
  }
  input.hash = fingerprint.text();
  if (arguments.command != "invariants") require_room_for_instants(input.problem);
  note_unstable_scheme(input);
  return input;
}

}  // namespace

Eigen::VectorXd read_design(const std::filesystem::path& path, const ProblemFile& problem) {
  if (std::filesystem::is_directory(path)) return read_design(path / "result.json", problem);
  const std::string file = path.string();
  const Json document = parse_json(read_text_file(path), file);
  const JsonNode root(document, file, "", "the design");
  const JsonNode variables = variables_of(root);
  check_names(variables, problem);
  Eigen::VectorXd x(problem.variables.size());
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    const DesignVariable& variable = problem.variables[i];
    const std::optional<JsonNode> value = variables.find(variable.name);
    if (!value) variables.fail(fmt::format("is missing the key \"{}\"", variable.name));
    x(i) = read_value(*value, variable);
  }
  return x;
}

Eigen::VectorXd design_of(const Arguments& arguments, const ProblemFile& problem) {
  Eigen::VectorXd design =
      arguments.design ? read_design(*arguments.design, problem) : start_design(problem);
  apply_named_values(arguments, problem, design);
  return design;
}

bool tries_a_design(const Arguments& arguments) {
  return arguments.design ||
         std::ranges::any_of(arguments.overrides, [](const std::string& assignment) {
           return !assigned_place(assignment).starts_with("/");
         });
}

void require_units(const Arguments& arguments) {
  if (arguments.overrides.empty()) return;
  std::vector<fs::path> files = arguments.files;
  if (!arguments.file.empty()) files.push_back(arguments.file);
  for (const fs::path& file : files) {
    if (!fs::exists(file)) continue;  // who reads it says so
    const Json document = parse_json(whole_text(file), file.string());
    for (const std::string& assignment : arguments.overrides) {
      require_unit(document, assignment, file.string());
    }
  }
}

ProblemInput read_input(const Arguments& arguments) {
  return read_file(arguments.file, arguments);
}

std::vector<ProblemInput> read_inputs(const Arguments& arguments) {
  std::vector<ProblemInput> inputs;
  for (const auto& file : arguments.files) inputs.push_back(read_file(file, arguments));
  return inputs;
}

}  // namespace pleuel
