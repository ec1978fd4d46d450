#include "cli/input/command_options.hpp"

namespace pleuel {

void add_overrides(CLI::App* command, Arguments& arguments) {
  command
      ->add_option(
          "--set", arguments.overrides,
          "override a value of the file: --set \"/simulation/step=0.1 ms\", or the start of "
          "a variable: --set \"rod_height=12 mm\"; repeatable")
      ->type_name("PLACE=VALUE")
      ->allow_extra_args(false);
  add_programs(command, arguments);
}

void add_programs(CLI::App* command, Arguments& arguments) {
  command->add_flag("--allow-programs", arguments.allows_programs,
                    "let programs run that the problem names (\"generator\" of bodies)");
}

void add_case(CLI::App* command, Arguments& arguments) {
  command
      ->add_option("--case", arguments.load_case,
                   "of a file with load cases this one alone (/cases of the file)")
      ->type_name("NAME");
}

void add_overwrite(CLI::App* command, Arguments& arguments) {
  command->add_flag("--overwrite", arguments.overwrites,
                    "replace an older run of this command in the same place");
}

void add_resume(CLI::App* command, Arguments& arguments) {
  command
      ->add_flag(
          "--resume", arguments.resumes,
          "go on with the run in the folder that was killed or interrupted: no evaluation is "
          "made twice")
      ->excludes("--overwrite");
}

void add_no_report(CLI::App* command, Arguments& arguments) {
  command->add_flag("--no-report", arguments.leaves_out_report,
                    "write no report.html; the command report makes it later");
}

CLI::Option* add_output(CLI::App* command, Arguments& arguments) {
  add_overwrite(command, arguments);
  add_no_report(command, arguments);
  return command
      ->add_option("-o,--output", arguments.output,
                   "run folder (default: the first of runs/<file>-" + command->get_name() +
                       ", …-2, …-3 that is not there)")
      ->type_name("DIR");
}

void add_design(CLI::App* command, Arguments& arguments) {
  command
      ->add_option("--design", arguments.design,
                   "at the design of a result.json or failed_design.json of an optimization, or "
                   "of a file {\"rod_height\": \"12 mm\", …}; an optimization begins there")
      ->type_name("FILE");
}

void add_all_warnings(CLI::App* command, Arguments& arguments) {
  command->add_flag("--all-warnings", arguments.wants_all_warnings,
                    "show warnings that may follow from others, too");
}

void add_checks(CLI::App* command, Arguments& arguments) {
  CLI::Option* all = command->add_flag_callback(
      "--all-checks", [&arguments] { arguments.scrutiny = Scrutiny::close; },
      "judge the numbers as those of an optimum: with half the step and twice the elements");
  command
      ->add_flag_callback(
          "--no-checks", [&arguments] { arguments.scrutiny = Scrutiny::none; },
          "look for nothing that speaks against the numbers")
      ->excludes(all);
}

void add_effects(CLI::App* command, Arguments& arguments) {
  command->add_flag("--effects", arguments.wants_effects,
                    "list all physical effects, also those that change next to nothing");
}

void add_verbose(CLI::App* command, Arguments& arguments, const std::string& what) {
  command->add_flag("--verbose", arguments.is_verbose,
                    "print " + what + ", too; result.json and the report have them in any case");
}

void add_accuracy(CLI::App* command, Arguments& arguments) {
  command
      ->add_option(
          "--accuracy", arguments.accuracy,
          "relative error of what is minimized or limited, such as 0.1% (or the ratio 0.001): "
          "steps, elements and effects are chosen for it")
      ->type_name("TARGET");
}

void add_backend(CLI::App* command, Arguments& arguments) {
  command
      ->add_option("--backend", arguments.backend,
                   "this optimizer alone, instead of the file's; see the command backends")
      ->type_name("NAME");
}

void add_starts(CLI::App* command, Arguments& arguments) {
  command
      ->add_option("--starts", arguments.starts,
                   "begin at so many designs, the start and others spread between the bounds")
      ->type_name("NUMBER")
      ->check(CLI::Range(1, 10000).description(""));
}

void add_method(CLI::App* command, Arguments& arguments) {
  command
      ->add_option("--method", arguments.methods,
                   "gradients instead of the file's: auto, direct, adjoint, forward-difference, "
                   "central-difference")
      ->type_name("NAME")
      ->expected(1);
}

void add_jobs(CLI::App* command, Arguments& arguments) {
  command
      ->add_option("--jobs", arguments.jobs,
                   "simulations at a time (default: the environment variable PLEUEL_JOBS, or all "
                   "processors)")
      ->type_name("NUMBER")
      ->check(CLI::Range(1, 1024).description(""));
}

void add_task_limit(CLI::App* command, Arguments& arguments, const std::string& task) {
  command
      ->add_option("--task-limit", arguments.task_limit,
                   "seconds after which the process of " + task +
                       " counts as hung; it is tried once more (default: none)")
      ->type_name("SECONDS")
      ->check(CLI::Validator(CLI::PositiveNumber).description(""));
}

}  // namespace pleuel
