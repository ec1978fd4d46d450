#include <algorithm>
#include <cstdio>
#include <map>
#include <new>
#include <string_view>

#include <fmt/format.h>
#include <unistd.h>

#include "cli/commands/commands.hpp"
#include "cli/commands/each_case.hpp"
#include "cli/input/parse_arguments.hpp"
#include "cli/input/run_setting.hpp"
#include "cli/interruption.hpp"
#include "cli/rank_of_job.hpp"
#include "cli/ranks.hpp"
#include "cli/text/console.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/error.hpp"
#include "core/base/excerpt.hpp"
#include "core/base/parallel.hpp"
#include "core/base/stop.hpp"

namespace pleuel {

namespace {

namespace fs = std::filesystem;

Outcome run(const Arguments& arguments) {
  static const std::map<std::string, Outcome (*)(const Arguments&)> commands = {
      {"accuracy", run_accuracy},
      {"backends", run_backends},
      {"check", run_check},
      {"compare", run_compare},
      {"completion", run_completion},
      {"export", run_export},
      {"gradient", run_gradient},
      {"invariants", run_invariants},
      {"new", run_new},
      {"optimize", run_optimize},
      {"pareto", run_pareto},
      {"plot", run_plot},
      {"prices", run_prices},
      {"report", run_report},
      {"runs", run_runs},
      {"schema", run_schema},
      {"show", run_show},
      {"simulate", run_simulate},
      {"stability", run_stability},
      {"uncertainty", run_uncertainty},
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

/// "/tmp/aaaa…: File name too long": long names are told by their beginnings.
std::string path_text(const fs::filesystem_error& error) {
  return fmt::format("{}: the system says: {}", excerpt(error.path1().string(), 120),
                     error.code().message());
}

/// However long names, keys and formulas of the user are.
constexpr std::size_t longest_message = 4000;

int report_error(ExitCode code, const std::string& whole_message, bool wants_json) {
  const std::string message = excerpt(whole_message, longest_message);
  const std::string text = fmt::format("pleuel: {}\n", message);
  show(stderr, ::isatty(STDERR_FILENO) == 1 ? wrapped(text, "  ") : text);  // a line for programs
  const int number = static_cast<int>(code);
  if (wants_json) {
    const Json document = {{"error", {{"exit_code", number}, {"message", message}}}};
    write_all(stdout, to_text(document));
  }
  return number;
}

/// Results in files are complete by then, or have been told of.
int print(const Outcome& outcome, bool wants_json) {
  const std::string failure =
      write_all(stdout, wants_json ? to_text(outcome.document) : outcome.text);
  if (!failure.empty()) {
    return report_error(ExitCode::fault, "standard output cannot be written: " + failure, false);
  }
  if (!outcome.unwritten.empty()) {
    show(stderr, fmt::format("pleuel: results that are not whole: {}\n",
                             fmt::join(outcome.unwritten, ", ")));
  }
  return outcome.final_code();
}

/// Of rank 0 of a job: the other ranks, each with so many workers as the arguments say.
std::vector<RankPlace> places_of(Ranks& ranks, const Arguments& arguments) {
  std::vector<RankPlace> places = ranks.take_places(arguments.gives_jobs ? arguments.jobs : 0);
  int workers = arguments.jobs;
  for (const RankPlace& place : places) workers += place.workers();
  show(stderr, fmt::format("pleuel: {}, {} workers\n", ranks.text(), workers));
  return places;
}

int guarded_main(int argc, const char* const* argv) {
  Arguments arguments;
  arguments.wants_json = std::find(argv, argv + argc, std::string_view("--json")) != argv + argc;
  const auto report = [&](ExitCode code, const std::string& message) {
    return report_error(code, message, arguments.wants_json);
  };
  try {
    std::optional<Ranks> ranks;
    if (const std::optional<RankOfJob> place = rank_of_job()) {
      std::vector<Channel> links = join_job(*place);
      if (place->rank > 0) {
        serve_rank_zero(std::move(links.front()));
        return 0;
      }
      ranks.emplace(std::move(links));
      limit_threads(ranks->processors_here());
    }
    const std::optional<Arguments> parsed = parse_arguments(argc, argv);
    if (!parsed) return 0;
    arguments = *parsed;
    take_setting_of_run(arguments);
    limit_threads(arguments.jobs);
    std::vector<RankPlace> others;
    if (ranks) others = places_of(*ranks, arguments);
    arguments.ranks = &others;
    const Interruption interruption;
    return print(run(arguments), arguments.wants_json);
  } catch (const InputError& error) {
    return report(ExitCode::bad_input, with_file(error.what(), arguments));
  } catch (const SimulationError& error) {
    return report(ExitCode::simulation_failed, with_file(error.what(), arguments));
  } catch (const fs::filesystem_error& error) {  // of a path that the user gave
    return report(ExitCode::bad_input, path_text(error));
  } catch (const Stopped&) {
    return report(ExitCode::not_verified, "interrupted before there was any result");
  } catch (const std::bad_alloc&) {
    return report(ExitCode::bad_input,
                  "the memory of the machine is used up: take a longer /simulation/step or a "
                  "shorter /simulation/end_time, a smaller /sensitivity/memory (then stretches are "
                  "simulated again), or fewer --jobs");
  } catch (const std::exception& error) {
    return report(ExitCode::fault,
                  fmt::format("{} (this is a fault of the program)", error.what()));
  }
}

}  // namespace

}  // namespace pleuel

int main(int argc, char** argv) {
  pleuel::prepare_streams();
  return pleuel::guarded_main(argc, argv);
}
