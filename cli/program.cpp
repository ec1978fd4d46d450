#include "cli/program.hpp"

#include <algorithm>
#include <string_view>

#include <unistd.h>

#include "cli/input/problem_input.hpp"
#include "cli/input/run_setting.hpp"
#include "cli/interruption.hpp"
#include "cli/rank_of_job.hpp"
#include "cli/ranks.hpp"
#include "cli/text/console.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/quoted.hpp"
#include "core/jobs/parallel.hpp"

namespace pleuel {

namespace {

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
  const std::string failure = write_all(
      stdout, wants_json ? to_text(outcome.document) : coloured_for(stdout, outcome.text));
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

}  // namespace

int run_program(int argc, const char* const* argv) noexcept {
  prepare_streams();
  Arguments arguments;
  arguments.wants_json = std::find(argv, argv + argc, std::string_view("--json")) != argv + argc;
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
    require_units(arguments);
    take_setting_of_run(arguments);
    limit_threads(arguments.jobs);
    std::vector<RankPlace> others;
    if (ranks) others = places_of(*ranks, arguments);
    arguments.ranks = &others;
    const Interruption interruption;
    return print(run_command(arguments), arguments.wants_json);
  } catch (...) {
    const Failure failure = current_failure();
    return report_error(failure.code, failure.message, arguments.wants_json);
  }
}

}  // namespace pleuel
