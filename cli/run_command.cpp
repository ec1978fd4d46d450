
#include "cli/commands/commands.hpp"
#include "cli/program.hpp"
#include "core/jobs/child_program.hpp"

namespace pleuel {

namespace {

Outcome run_named(const Arguments& arguments) {
  static const std::map<std::string, Outcome (*)(const Arguments&)> commands = {
      {"accuracy", run_accuracy}, {"backends", run_backends},     {"check", run_check},
      {"compare", run_compare},   {"completion", run_completion}, {"export", run_export},
      {"gradient", run_gradient}, {"invariants", run_invariants}, {"new", run_new},
      {"optimize", run_optimize}, {"pareto", run_pareto},         {"plot", run_plot},
      {"prices", run_prices},     {"reduce", run_reduce},         {"report", run_report},
      {"runs", run_runs},         {"schema", run_schema},         {"show", run_show},
      {"simulate", run_simulate}, {"stability", run_stability},   {"uncertainty", run_uncertainty},
  };
  const auto command = commands.at(arguments.command);
  if (asks_for_each_case(arguments)) return run_each_case(arguments, command);
  Outcome outcome = command(arguments);
  outcome.text += limits_left_out_text(arguments);
  return outcome;
}

/// Errors of the lower floors begin with the JSON pointer, or with the load case that they are of;
/// only we know the file.
std::string with_file(const std::string& message, const Arguments& arguments) {
  const auto begins_with = [&](const fs::path& file) { return message.starts_with(file.string()); };
  const bool names_file = arguments.file.empty() || begins_with(arguments.file) ||
                          (arguments.design && begins_with(*arguments.design));
  const bool is_of_file = message.starts_with("/") || message.starts_with("in the case \"");
  return is_of_file && !names_file ? arguments.file.string() + ": " + message : message;
}

}  // namespace

Outcome run_command(const Arguments& arguments) {
  std::optional<ProgramPermission> permission;
  if (arguments.allows_programs) permission.emplace();
  try {
    Outcome outcome = run_named(arguments);
    outcome.document = versioned(outcome.document);
    return outcome;
  } catch (const InputError& error) {
    throw InputError(with_file(error.what(), arguments));
  } catch (const SimulationError& error) {
    throw SimulationError(with_file(error.what(), arguments));
  }
}

}  // namespace pleuel
