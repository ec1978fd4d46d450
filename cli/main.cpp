#include <algorithm>
#include <cstdio>
#include <map>
#include <string_view>

#include <fmt/format.h>

#include "cli/commands.hpp"
#include "core/base/error.hpp"

namespace pleuel {

namespace {

namespace fs = std::filesystem;

Outcome run(const Arguments& arguments) {
  static const std::map<std::string, Outcome (*)(const Arguments&)> commands = {
      {"accuracy", run_accuracy},     {"backends", run_backends},
      {"check", run_check},           {"gradient", run_gradient},
      {"invariants", run_invariants}, {"optimize", run_optimize},
      {"pareto", run_pareto},         {"simulate", run_simulate},
      {"stability", run_stability},   {"uncertainty", run_uncertainty},
  };
  return commands.at(arguments.command)(arguments);
}

/// Errors of the lower floors begin with the JSON pointer; only we know the file.
std::string with_file(const std::string& message, const Arguments& arguments) {
  const auto begins_with = [&](const fs::path& file) { return message.starts_with(file.string()); };
  const bool names_file = arguments.file.empty() || begins_with(arguments.file) ||
                          (arguments.design && begins_with(*arguments.design));
  return message.starts_with("/") && !names_file ? arguments.file.string() + ": " + message
                                                 : message;
}

int report_error(ExitCode code, const std::string& message, bool wants_json) {
  fmt::print(stderr, "pleuel: {}\n", message);
  const int number = static_cast<int>(code);
  if (wants_json) {
    const Json document = {{"error", {{"exit_code", number}, {"message", message}}}};
    fmt::print("{}", to_text(document));
  }
  return number;
}

/// @throws InputError if not all of it could be written
void print_whole(const std::string& text) {
  const bool is_written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (std::fflush(stdout) != 0 || !is_written) {
    throw InputError("standard output cannot be written; results in files are complete");
  }
}

int guarded_main(int argc, const char* const* argv) {
  Arguments arguments;
  arguments.wants_json = std::find(argv, argv + argc, std::string_view("--json")) != argv + argc;
  try {
    const std::optional<Arguments> parsed = parse_arguments(argc, argv);
    if (!parsed) return 0;
    arguments = *parsed;
    const Outcome outcome = run(arguments);
    print_whole(arguments.wants_json ? to_text(outcome.document) : outcome.text);
    return static_cast<int>(outcome.exit_code);
  } catch (const InputError& error) {
    return report_error(ExitCode::bad_input, with_file(error.what(), arguments),
                        arguments.wants_json);
  } catch (const SimulationError& error) {
    return report_error(ExitCode::simulation_failed, error.what(), arguments.wants_json);
  } catch (const std::exception& error) {
    return report_error(ExitCode::fault,
                        fmt::format("{} (this is a fault of the program)", error.what()),
                        arguments.wants_json);
  }
}

}  // namespace

}  // namespace pleuel

int main(int argc, char** argv) {
  return pleuel::guarded_main(argc, argv);
}
