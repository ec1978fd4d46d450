#include "cli/input/run_setting.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "cli/text/console.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/error.hpp"
#include "core/scene/reading/override.hpp"
#include "core/scene/reading/syntax_error.hpp"
#include "optimization/backends.hpp"

namespace pleuel {

namespace {

/// Commands whose answer is about the design as it is.
constexpr std::array<std::string_view, 5> commands = {"simulate", "gradient", "check", "prices",
                                                      "uncertainty"};

Json document_of(const fs::path& file) {
  return parse_json(read_text_file(file), file.string());
}

/// Whether the setting was chosen for an accuracy: stages have a target then.
bool was_chosen(const Json& result) {
  const Json stages = result.value("stages", Json::array());
  return !stages.empty() && stages.back().contains("target");
}

/// Whether the problem has what a chosen number is of.
bool has_place(const Json& problem, const Json::json_pointer& place) {
  const std::string text = place.to_string();
  if (!text.starts_with("/scene/")) return true;
  if (!problem.contains(place.parent_pointer())) return false;
  const Json& owner = problem.at(place.parent_pointer());
  return place.back() != "elements" || !owner.is_object() || !owner.contains("segments");
}

/// The place in a whole file at which a load case changes another place.
std::string place_in_case(const std::string& load_case, const Json::json_pointer& place) {
  return (Json::json_pointer("/cases") / load_case / place.to_string()).to_string();
}

/// What the command line itself says stands above it.
bool is_given(const std::string& place, const std::vector<std::string>& assignments) {
  return std::ranges::any_of(assignments, [&](const std::string& assignment) {
    return assignment.starts_with(place + "=");
  });
}

/// An assignment, and how it is told.
struct Assignment {
  std::string text, shown;
};

using Assignments = std::vector<Assignment>;

/// Adds what was chosen for a problem, or for one of its load cases, but for what the command line gives.
/// @returns whether the problem has a place for all of it
bool add_assignments(const Json& chosen, const Json& problem, const std::string& load_case,
                     const std::vector<std::string>& given, Assignments& all) {
  if (!chosen.contains("overrides")) return false;
  for (const auto& [text, value] : chosen.at("overrides").items()) {
    const Json::json_pointer place(text);
    // The lengths of segments may go by their elements, and masses with them.
    const bool is_of_segment = text.find("/segments/") != std::string::npos;
    if (!has_place(problem, place) || (is_of_segment && !load_case.empty())) return false;
    const std::string whole = load_case.empty() ? text : place_in_case(load_case, place);
    if (is_given(text, given) || is_given(whole, given)) continue;
    all.push_back({fmt::format("{}={}", whole, value.dump()),
                   fmt::format("{}={}{}", text, value.dump(),
                               load_case.empty() ? "" : " in case " + load_case)});
  }
  return true;
}

/// What a run has chosen for one load case: an optimization for all of them, or for this one alone.
Json chosen_in_case(const Json& setting, const std::string& load_case, const Arguments& arguments) {
  if (setting.contains("cases")) return setting.at("cases").value(load_case, Json());
  return arguments.load_case ? setting : Json();
}

/// @param setting  of the result of an optimization
/// @param problem  the file with the assignments of the command line
/// @returns nothing if the problem is not that of the run
std::optional<Assignments> assignments_of_run(const Json& setting, const Json& problem,
                                              const Arguments& arguments) {
  Assignments all;
  const Json cases = problem.value("cases", Json::object());
  bool fits = !cases.empty() || add_assignments(setting, problem, "", arguments.overrides, all);
  for (const auto& [name, changes] : cases.items()) {
    if (arguments.load_case && name != *arguments.load_case) continue;
    fits = fits && changes.is_object() &&
           add_assignments(chosen_in_case(setting, name, arguments), problem, name,
                           arguments.overrides, all);
  }
  return fits ? std::optional(all) : std::nullopt;
}

/// Empty where no accuracy was asked of the run, or where one is asked for now; nothing if the run is
/// of another mechanism.
std::optional<Assignments> setting_of_run(const Arguments& arguments) {
  const fs::path& design = *arguments.design;
  const Json result = document_of(fs::is_directory(design) ? design / "result.json" : design);
  if (!result.contains("setting") || !was_chosen(result)) return Assignments();
  Json problem = document_of(arguments.file);
  for (const std::string& assignment : arguments.overrides) {
    apply_override(problem, assignment, arguments.file.string());
  }
  if (problem.contains(Json::json_pointer("/accuracy/target"))) return Assignments();
  return assignments_of_run(result.at("setting"), problem, arguments);
}

}  // namespace

void take_setting_of_run(Arguments& arguments) {
  const bool looks_at_it = std::ranges::find(commands, arguments.command) != commands.end();
  if (!looks_at_it || !arguments.design) return;
  std::optional<Assignments> found;
  try {
    found = setting_of_run(arguments);
  } catch (const InputError&) {
    return;  // who reads the design says more of it
  } catch (const Json::exception&) {
    return;  // a damaged document
  }
  const std::string run = arguments.design->string();
  if (!found) {
    show(stderr, wrapped(fmt::format("{}: note: simulated with the steps and elements of the file, "
                                     "since those of this optimum do not fit it\n",
                                     run)));
  }
  if (!found || found->empty()) return;
  std::vector<std::string> shown, overrides;
  for (const Assignment& one : *found) {
    shown.push_back(one.shown);
    overrides.push_back(one.text);
  }
  show(stderr, wrapped(fmt::format("{}: note: simulated with the steps and elements that this "
                                   "optimum was found with ({}); --set takes others\n",
                                   run, fmt::join(shown, ", "))));
  arguments.overrides.insert(arguments.overrides.begin(), overrides.begin(), overrides.end());
}

SolveOptions solve_options(const ProblemFile& problem, const Arguments& arguments) {
  SolveOptions options;
  options.backend = arguments.backend.value_or(problem.optimizer.backend);
  if (!arguments.backend && !problem.optimizer.names_backend) {
    options.other_backends = {"nlopt-mma", "ipopt", "nlopt-ccsaq"};
  }
  options.tolerance = problem.optimizer.tolerance;
  options.checks_numbers = arguments.scrutiny != Scrutiny::none;
  options.max_iterations = problem.optimizer.max_iterations;
  try {
    make_optimizer(options.backend, {options.tolerance});
  } catch (const InputError& error) {
    throw InputError((arguments.backend ? "--backend: " : "/optimizer/backend: ") +
                     std::string(error.what()));
  }
  return options;
}

Json options_document(const SolveOptions& options, const ProblemFile& problem) {
  return {{"backend", options.backend},
          {"other_backends", options.other_backends},
          {"method", to_string(problem.sensitivity.method)},
          {"tolerance", options.tolerance},
          {"max_iterations", options.max_iterations},
          {"max_restarts", options.max_restarts},
          {"max_escapes", options.max_escapes},
          {"max_consecutive_failures", options.max_consecutive_failures},
          {"max_polishes", options.max_polishes},
          {"polish_iterations", options.polish_iterations},
          {"patience", options.patience},
          {"verdict",
           {{"kkt_residual", options.verdict.kkt_residual},
            {"variable_residual", options.verdict.variable_residual},
            {"violation", options.verdict.violation},
            {"gradient", options.verdict.gradient},
            {"gain", options.verdict.gain}}}};
}

}  // namespace pleuel
