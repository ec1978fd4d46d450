#include <array>

#include "cli/commands/commands.hpp"
#include "cli/reports/case_report.hpp"
#include "core/base/plain_file_name.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/problem_reader.hpp"
#include "core/scene/reading/document_reader.hpp"
#include "core/scene/reading/syntax_error.hpp"

namespace pleuel {

namespace {

constexpr std::array commands = {"simulate", "check",    "gradient",
                                 "show",     "accuracy", "uncertainty"};

std::vector<std::string> case_names(const Arguments& arguments) {
  const Json document = overridden_document(
      {read_text_file(arguments.file), arguments.file.string(), arguments.overrides});
  return list_of(cases_of(document, arguments.file.string()), &CaseChanges::name);
}

/// Tells errors of the input by the case that they are of; those of the file are of all.
Outcome run_case(const Arguments& arguments, Outcome (*command)(const Arguments&)) {
  try {
    return command(arguments);
  } catch (const InputError& error) {
    const std::string message = error.what();
    const bool names_file = message.starts_with(arguments.file.string());
    if (names_file || !message.starts_with("/")) throw;
    throw InputError(fmt::format("in the case \"{}\": {}", *arguments.load_case, message));
  }
}

/// What is made from several cases: no case has it.
void add_numbers_over_cases(const Arguments& arguments, Outcome& all) {
  const bool has_values = arguments.command == "simulate" || arguments.command == "gradient" ||
                          arguments.command == "uncertainty";
  if (!has_values) return;
  for (const auto& [name, document] : all.document["cases"].items()) {
    if (!document.contains("responses")) return;  // it could not be simulated
  }
  const ProblemFile joined = read_problem(arguments.file, arguments.overrides).complete();
  const Json document =
      over_cases_document(joined, design_of(arguments, joined), all.document["cases"]);
  if (document.is_null()) return;
  all.document["over_cases"] = document;
  all.text += over_cases_text(joined, document);
  if (lacks_numbers(document)) {
    all.exit_code = std::max(all.exit_code, ExitCode::simulation_failed);
  }
  const bool keeps = broken_limits(document.value("constraints", Json::object())).empty();
  if (arguments.command == "simulate" && tries_a_design(arguments) && !keeps) {
    all.exit_code = std::max(all.exit_code, ExitCode::not_verified);
  }
}

/// The others are simulated all the same.
Outcome failed_case(const Arguments& arguments, const std::string& name,
                    const std::string& reason) {
  show(stderr,
       fmt::format("pleuel: {}: in the case \"{}\": {}\n", arguments.file.string(), name, reason));
  return {ExitCode::simulation_failed,
          {{"status", "failed"}, {"error", reason}},
          wrapped(fmt::format("The case \"{}\" cannot be simulated: {}", name, reason)) + "\n"};
}

}  // namespace

std::string limits_left_out_text(const Arguments& arguments) {
  constexpr std::array with_limits = {"simulate", "optimize", "prices"};
  const bool has_limits = std::ranges::find(with_limits, arguments.command) != with_limits.end();
  if (!has_limits || !arguments.load_case) return "";
  const ProblemFile joined = read_problem(arguments.file, arguments.overrides).complete();
  std::vector<std::string> names;
  for (std::size_t i = 0; joined.has_cases() && i < joined.constraints.size(); ++i) {
    if (is_of_several(joined.case_constraints[i])) names.push_back(joined.constraints[i].name);
  }
  if (names.empty()) return "";
  return wrapped(fmt::format("Not looked at, as it takes several cases: the {} {}.\n",
                             names.size() == 1 ? "limit" : "limits", fmt::join(names, ", ")),
                 "  ");
}

bool asks_for_each_case(const Arguments& arguments) {
  const bool is_such = std::ranges::find(commands, arguments.command) != commands.end();
  return is_such && !arguments.load_case && !case_names(arguments).empty();
}

Outcome run_each_case(const Arguments& arguments, Outcome (*command)(const Arguments&)) {
  Outcome all;
  all.document = {{"cases", Json::object()}};
  const std::vector<std::string> names = case_names(arguments);
  for (const std::string& name : names) {
    Arguments one = arguments;
    one.load_case = name;
    if (arguments.output) one.output = *arguments.output / plain_file_name(name);
    Outcome outcome;
    try {
      outcome = run_case(one, command);
    } catch (const SimulationError& error) {
      outcome = failed_case(arguments, name, error.what());
    } catch (const Stopped&) {
      if (all.text.empty()) throw;
      all.exit_code = std::max(all.exit_code, ExitCode::not_verified);
      all.text += fmt::format("\nInterrupted before the case \"{}\".\n", name);
      return all;
    }
    all.document["cases"][name] = outcome.document;
    all.text +=
        fmt::format("{}Case \"{}\"\n\n{}", all.text.empty() ? "" : "\n", name, outcome.text);
    all.exit_code = std::max(all.exit_code, outcome.exit_code);
    all.unwritten.insert(all.unwritten.end(), outcome.unwritten.begin(), outcome.unwritten.end());
  }
  add_numbers_over_cases(arguments, all);
  return all;
}

}  // namespace pleuel
