#include "cli/input/parse_arguments.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/input/command_options.hpp"
#include "cli/input/help_texts.hpp"
#include "cli/input/version_text.hpp"
#include "cli/text/console.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/error.hpp"
#include "core/scene/reading/suggestion.hpp"

namespace pleuel {

namespace {

/// Where the library begins what it says of an option.
constexpr std::size_t help_column = 30;

constexpr const char* footer = R"(
Every command that takes a problem also takes --set (repeatable) and --json.
Exit codes: 0 done, 2 bad input, 3 simulation failed, 4 ended without a verified optimum,
interrupted, or a design of simulate --design breaks a limit, 1 a result that could not be
written, or a fault of the program.)";

CLI::App* add_command(CLI::App& app, Arguments& arguments, const std::string& name,
                      const std::string& description) {
  CLI::App* command = app.add_subcommand(name, description);
  command->footer(help_text(name));
  command->add_flag("--json", arguments.wants_json,
                    "print the result as one JSON document on standard output");
  return command;
}

CLI::App* add_file_command(CLI::App& app, Arguments& arguments, const std::string& name,
                           const std::string& description) {
  CLI::App* command = add_command(app, arguments, name, description);
  command->add_option("FILE", arguments.file, "problem file (JSON)")->required();
  add_overrides(command, arguments);
  add_case(command, arguments);
  return command;
}

void add_uncertainty(CLI::App& app, Arguments& arguments) {
  CLI::App* uncertainty =
      add_file_command(app, arguments, "uncertainty",
                       "deviations and bounds of responses; Monte Carlo as the check");
  add_design(uncertainty, arguments);
  add_output(uncertainty, arguments);
  add_resume(uncertainty, arguments);
  add_accuracy(uncertainty, arguments);
  add_jobs(uncertainty, arguments);
  add_task_limit(uncertainty, arguments, "eight samples");
}

void add_stability(CLI::App& app, Arguments& arguments) {
  CLI::App* stability = add_command(app, arguments, "stability",
                                    "drift, energy and work of files x formulations and schemes");
  stability->add_option("FILE", arguments.files, "problem files (JSON)")->required();
  add_overrides(stability, arguments);
  add_case(stability, arguments);
  add_output(stability, arguments);
}

void add_gradient(CLI::App& app, Arguments& arguments) {
  CLI::App* gradient = add_file_command(
      app, arguments, "gradient",
      "derivatives of all responses by the variables, at the start or another design");
  add_design(gradient, arguments);
  gradient
      ->add_option("--method", arguments.methods,
                   "instead of the file's: auto (direct or adjoint, whichever is faster), direct, "
                   "adjoint, forward-difference, central-difference; repeat to compare")
      ->type_name("NAME")
      ->allow_extra_args(false);
  gradient
      ->add_option("--step", arguments.difference_step,
                   "relative step of the differences instead of the file's")
      ->type_name("NUMBER");
  add_jobs(gradient, arguments);
  add_accuracy(gradient, arguments);
  add_all_warnings(gradient, arguments);
  add_checks(gradient, arguments);
  gradient->add_flag("--histories", arguments.wants_histories,
                     "write the derivatives of all histories into a run folder");
  gradient
      ->add_option("--by-invariants", arguments.differentiated_body,
                   "also derivatives by each number of this body, which is of the type "
                   "\"invariants\": a finite-element program makes those by its variables of them")
      ->type_name("BODY");
  gradient->add_flag("--compare", arguments.compares_methods,
                     "effort and accuracy of all methods, of differences with steps from 1e-2 to "
                     "1e-8, into a run folder");
  add_output(gradient, arguments);
}

void add_invariants(CLI::App& app, Arguments& arguments) {
  CLI::App* invariants =
      add_file_command(app, arguments, "invariants",
                       "write what the mechanics knows of elastic bodies, with derivatives");
  invariants->add_option("--body", arguments.body, "this body only (default: all elastic ones)")
      ->type_name("NAME");
  invariants
      ->add_option("-o,--output", arguments.output,
                   "a file NAME.json, or a run folder (default: runs/<file>-invariants)")
      ->type_name("PATH");
  add_overwrite(invariants, arguments);
}

void add_reduce(CLI::App& app, Arguments& arguments) {
  CLI::App* reduce =
      add_command(app, arguments, "reduce", "make a body of a finite-element model of a solid");
  reduce->add_option("FILE", arguments.file, "model file (JSON)")->required();
  reduce->add_option("-o,--output", arguments.output, "the file of invariants to write")
      ->type_name("FILE.json")
      ->required();
  add_overwrite(reduce, arguments);
}

void add_prices(CLI::App& app, Arguments& arguments) {
  CLI::App* prices = add_file_command(app, arguments, "prices",
                                      "what the optimum would gain by each number of the file");
  prices
      ->add_option("--design", arguments.design,
                   "the optimum: result.json of an optimization (default: it is looked for first)")
      ->type_name("FILE");
  add_output(prices, arguments);
  add_accuracy(prices, arguments);
  add_backend(prices, arguments);
  add_method(prices, arguments);
  add_jobs(prices, arguments);
}

void add_accuracy(CLI::App& app, Arguments& arguments) {
  CLI::App* accuracy =
      add_file_command(app, arguments, "accuracy",
                       "errors and times for steps x elements; the cheapest that will do");
  add_output(accuracy, arguments);
  add_resume(accuracy, arguments);
  add_design(accuracy, arguments);
  accuracy->add_flag("--optimum", arguments.wants_optimum,
                     "at the optimum (that of --design, or it is looked for), and with whole "
                     "optimizations for the settings that are worth it");
  add_verbose(accuracy, arguments, "the errors and times of all settings");
  add_backend(accuracy, arguments);
}

void add_report(CLI::App& app, Arguments& arguments) {
  CLI::App* report =
      add_command(app, arguments, "report", "write report.html into folders of earlier runs");
  report->add_option("DIR", arguments.files, "run folders")->required();
}

void add_runs(CLI::App& app, Arguments& arguments) {
  CLI::App* runs =
      add_command(app, arguments, "runs", "list runs: command, problem, status, objective, time");
  runs->add_option("DIR", arguments.file, "folder that holds run folders (default: runs)");
  runs->add_option("--sort", arguments.order, "time (default; the newest is the last) or name")
      ->type_name("KEY")
      ->check(CLI::IsMember({"time", "name"}));
}

void add_compare(CLI::App& app, Arguments& arguments) {
  CLI::App* compare = add_command(app, arguments, "compare",
                                  "two runs side by side: what differs in input and outcome");
  compare->add_option("DIR", arguments.files, "the two run folders")->required()->expected(2);
  compare
      ->add_option("-o,--output", arguments.output,
                   "the page to write (default: the first of runs/compare.html, …-2 that is not "
                   "there)")
      ->type_name("FILE.html");
  add_programs(compare, arguments);
}

void add_export(CLI::App& app, Arguments& arguments) {
  CLI::App* command = add_command(app, arguments, "export",
                                  "write the evaluations of optimize or pareto as tables (CSV)");
  command->add_option("DIR", arguments.file, "run folder")->required();
  command
      ->add_option("-o,--output", arguments.output, "where the files go (default: the run folder)")
      ->type_name("DIR");
  add_programs(command, arguments);
  command->add_flag("--vtk", arguments.wants_vtk,
                    "write the motion of start and optimum for ParaView, too, which are simulated "
                    "again");
}

void add_plot(CLI::App& app, Arguments& arguments) {
  CLI::App* plot =
      add_command(app, arguments, "plot", "draw histories of a run: as SVG, and in the terminal");
  plot->add_option("DIR", arguments.file, "run folder")->required();
  plot->add_option("NAME", arguments.names,
                   "responses with histories (default: the names of all are listed)");
  plot->add_option("-o,--output", arguments.output,
                   "the drawing to write (default: DIR/plot-NAME.svg, or plot.svg of several)")
      ->type_name("FILE.svg");
}

void add_show(CLI::App& app, Arguments& arguments) {
  CLI::App* show = add_file_command(
      app, arguments, "show", "draw the mechanism of a file as a page, before it is simulated");
  show->add_option("-o,--output", arguments.output,
                   "the page to write, or a run folder (default: the first of "
                   "runs/<file>-show.html, …-2 that is not there)")
      ->type_name("FILE.html|DIR");
  add_overwrite(show, arguments);
  add_design(show, arguments);
}

void add_new(CLI::App& app, Arguments& arguments) {
  CLI::App* command = add_command(app, arguments, "new",
                                  "write a small problem file to begin with; alone: list them");
  command->add_option("KIND", arguments.kind, "what mechanism: see the list");
  command->add_option("FILE", arguments.file, "where to (default: KIND.json)");
  command->add_flag("--overwrite", arguments.overwrites, "replace files that are there");
}

void add_schema(CLI::App& app, Arguments& arguments) {
  CLI::App* command =
      add_command(app, arguments, "schema",
                  "print or write the JSON schema of problem files, by which editors complete");
  command->add_option("FILE", arguments.file, "where to (default: standard output)");
  command->add_flag("--overwrite", arguments.overwrites, "replace a file that is there");
}

void add_completion(CLI::App& app, Arguments& arguments) {
  CLI::App* command = add_command(app, arguments, "completion",
                                  "print the completion of commands and options for a shell");
  command->add_option("SHELL", arguments.kind, "bash or zsh")->required();
}

void add_check(CLI::App& app, Arguments& arguments) {
  CLI::App* check = add_file_command(
      app, arguments, "check",
      "validate, describe the mechanism, verify the derivatives, estimate the time");
  add_design(check, arguments);
  add_effects(check, arguments);
  add_all_warnings(check, arguments);
  add_jobs(check, arguments);
  add_overwrite(check, arguments);
  add_no_report(check, arguments);
  check
      ->add_option("-o,--output", arguments.output,
                   "run folder for result.json and report.html (default: nothing is written)")
      ->type_name("DIR");
}

void add_simulate(CLI::App& app, Arguments& arguments) {
  CLI::App* simulate = add_file_command(app, arguments, "simulate",
                                        "simulate one design and say whether it keeps its limits");
  add_output(simulate, arguments);
  add_all_warnings(simulate, arguments);
  add_checks(simulate, arguments);
  add_accuracy(simulate, arguments);
  simulate->add_flag("--effects", arguments.wants_effects,
                     "show what each effect brings and costs: a simulation more for each");
  add_design(simulate, arguments);
}

void add_optimize(CLI::App& app, Arguments& arguments) {
  CLI::App* optimize = add_file_command(app, arguments, "optimize",
                                        "find the best design within the limits, and verify it");
  add_output(optimize, arguments);
  add_all_warnings(optimize, arguments);
  add_checks(optimize, arguments);
  add_resume(optimize, arguments);
  add_accuracy(optimize, arguments);
  add_design(optimize, arguments);
  add_verbose(optimize, arguments, "the audit, prices of limits, drives and effects");
  add_effects(optimize, arguments);
  add_backend(optimize, arguments);
  add_starts(optimize, arguments);
  add_method(optimize, arguments);
  add_jobs(optimize, arguments);
  add_task_limit(optimize, arguments, "one of several starts");
}

void add_pareto(CLI::App& app, Arguments& arguments) {
  CLI::App* pareto = add_file_command(app, arguments, "pareto",
                                      "the best designs for a row of values of one limit");
  add_output(pareto, arguments);
  add_resume(pareto, arguments);
  pareto
      ->add_option("--gap", arguments.gap,
                   "more points, until no neighbours are further apart, both goals over their "
                   "ranges: such as 0.05 or 5%")
      ->type_name("NUMBER");
  add_accuracy(pareto, arguments);
  add_backend(pareto, arguments);
  add_method(pareto, arguments);
  add_jobs(pareto, arguments);
  add_task_limit(pareto, arguments, "one point");
}

}  // namespace

/// In the order in which one meets them.
void add_commands(CLI::App& app, Arguments& arguments) {
  add_new(app, arguments);
  add_show(app, arguments);
  add_simulate(app, arguments);
  add_optimize(app, arguments);
  add_check(app, arguments);
  add_accuracy(app, arguments);
  add_uncertainty(app, arguments);
  add_pareto(app, arguments);
  add_prices(app, arguments);
  add_gradient(app, arguments);
  add_compare(app, arguments);
  add_runs(app, arguments);
  add_report(app, arguments);
  add_plot(app, arguments);
  add_export(app, arguments);
  add_stability(app, arguments);
  add_invariants(app, arguments);
  add_reduce(app, arguments);
  add_command(app, arguments, "backends", "list the optimizers");
  add_schema(app, arguments);
  add_completion(app, arguments);
}

namespace {

/// A misspelt command deserves better than "not expected".
void check_command_name(const CLI::App& app, const std::vector<std::string>& words) {
  if (words.empty() || words.front().starts_with("-")) return;
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands({})) known.push_back(command->get_name());
  if (std::find(known.begin(), known.end(), words.front()) != known.end()) return;
  throw InputError(
      fmt::format("there is no command \"{}\"{}", words.front(), hint(words.front(), known)));
}

/// "; did you mean --accuracy?" of the first option that the command does not have.
std::string option_hint(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* command = nullptr;
  for (const CLI::App* one : app.get_subcommands({})) {
    if (!words.empty() && one->get_name() == words.front()) command = one;
  }
  if (command == nullptr) return "";
  std::vector<std::string> known;
  for (const CLI::Option* option : command->get_options()) {
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  }
  for (const std::string& word : words) {
    const std::string name = word.substr(0, word.find('='));
    if (!name.starts_with("--") || command->get_option_no_throw(name) != nullptr) continue;
    const std::string meant = closest(name, known);
    return meant.empty() ? "" : fmt::format("; did you mean {}?", meant);
  }
  return "";
}

/// What the environment says in place of --jobs.
void take_jobs_of_environment(Arguments& arguments) {
  const char* text = std::getenv("PLEUEL_JOBS");
  if (text == nullptr || *text == '\0') return;
  const char* end = text + std::strlen(text);
  const auto [rest, error] = std::from_chars(text, end, arguments.jobs);
  if (error != std::errc() || rest != end || arguments.jobs < 1 || arguments.jobs > 1024) {
    throw InputError(fmt::format(
        "the environment variable PLEUEL_JOBS must be a whole number from 1 to 1024, got \"{}\"",
        text));
  }
  arguments.gives_jobs = true;
}

/// Who writes "--accuracy 0.1" may mean 10 % or 0.1 %: such numbers need their "%".
void check_accuracy(const std::string& text) {
  constexpr double ambiguous = 0.02;
  double ratio = 0.0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, ratio);
  if (error != std::errc() || rest != end || ratio < ambiguous) return;
  throw InputError(
      ratio < 1.0
          ? fmt::format(
                "--accuracy {0} is a ratio, {1:g} %: write --accuracy {0}% for {0} percent, "
                "or --accuracy {1:g}% if that is what you mean",
                text, 100.0 * ratio)
          : fmt::format(
                "--accuracy {0} is a ratio and has to be below 1; write --accuracy {0}% for "
                "{0} percent",
                text));
}

}  // namespace

std::optional<Arguments> parse_arguments(int argc, const char* const* argv) {
  Arguments arguments;
  take_jobs_of_environment(arguments);
  arguments.program = argc > 0 ? argv[0] : "pleuel";
  arguments.words.assign(argv + std::min(argc, 1), argv + argc);
  std::vector<std::string> words = arguments.words;
  if (!words.empty() && words.front() == "help") {  // help COMMAND
    words.erase(words.begin());
    words.push_back("--help");
  }
  CLI::App app("Pleuel: gradient-based design optimization of flexible mechanisms",
               arguments.program);
  app.footer(footer);
  app.require_subcommand(1);
  app.set_version_flag("--version", version_text());
  add_commands(app, arguments);
  check_command_name(app, words);
  try {
    std::reverse(words.begin(), words.end());  // as the library wants them
    app.parse(words);
  } catch (const CLI::Success& success) {
    std::ostringstream text;
    app.exit(success, text);
    write_all(stdout, wrapped(text.str(), std::string(help_column, ' ')));
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    const bool has_command = !arguments.words.empty() && !arguments.words.front().starts_with("-");
    const bool is_unknown = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
    const std::string meant = is_unknown ? option_hint(app, arguments.words) : "";
    throw InputError(fmt::format("{}{}; see {}{} --help", error.what(), meant, arguments.program,
                                 has_command ? " " + arguments.words.front() : ""));
  }
  const double step = arguments.difference_step.value_or(0.5);
  if (!(step > 0.0 && step < 1.0)) {
    throw InputError(fmt::format("--step must be greater than 0 and less than 1, got {:g}", step));
  }
  const CLI::App* command = app.get_subcommands().front();
  arguments.command = command->get_name();
  const CLI::Option* jobs = command->get_option_no_throw("--jobs");
  if (jobs != nullptr && jobs->count() > 0) arguments.gives_jobs = true;
  if (arguments.accuracy) {
    check_accuracy(*arguments.accuracy);
    arguments.overrides.push_back("/accuracy/target=" + *arguments.accuracy);
  }
  if (arguments.gap) arguments.overrides.push_back("/pareto/gap=" + *arguments.gap);
  return arguments;
}

}  // namespace pleuel
