#include "cli/input/problem_input.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "cli/input/design_file.hpp"
#include "cli/input/fingerprint.hpp"
#include "cli/text/console.hpp"
#include "core/base/error.hpp"
#include "core/response/effect_measurement.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/reading/document_reader.hpp"
#include "core/scene/reading/override.hpp"

namespace pleuel {

namespace {

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
  input.effective = parse_json(input.text.text, file.string());
  Fingerprint fingerprint;
  fingerprint.add(input.text.text);
  for (const std::string& assignment : arguments.overrides) {
    apply_override(input.effective, assignment, file.string());
    fingerprint.add(assignment);
  }
  if (arguments.load_case) {
    input.effective = document_in_case(input.effective, *arguments.load_case, file.string());
    fingerprint.add(*arguments.load_case);
  }
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

Json document_in_case(const Json& document, const std::string& load_case, const std::string& file) {
  for (const CaseChanges& changes : cases_of(document, file)) {
    if (changes.name == load_case) return document_of_case(document, changes, file);
  }
  throw InputError(fmt::format("{}: /cases has no case \"{}\"", file, load_case));
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
