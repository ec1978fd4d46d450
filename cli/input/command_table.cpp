#include "cli/input/command_table.hpp"

#include <CLI/CLI.hpp>

namespace pleuel {

namespace {

void is_required(CLI::Option& option) {
  option.required();
}

void takes_one(CLI::Option& option) {
  option.expected(1);
}

/// Of a list: the next word belongs to it only if the option is repeated.
void is_repeated(CLI::Option& option) {
  option.allow_extra_args(false);
}

template <int most>
void counts_to(CLI::Option& option) {
  option.check(CLI::Range(1, most).description(""));
}

const OptionKind json{"--json", &Arguments::wants_json,
                      "print the result as one JSON document on standard output"};
const OptionKind overrides{
    "--set", &Arguments::overrides,
    "override a value of the file: --set \"/simulation/step=0.1 ms\", or the start of a variable: "
    "--set \"rod_height=12 mm\"; repeatable",
    "PLACE=VALUE", is_repeated};
const OptionKind programs{"--allow-programs", &Arguments::allows_programs,
                          "let programs run that the problem names (\"generator\" of bodies)"};
const OptionKind load_case{"--case", &Arguments::load_case,
                           "of a file with load cases this one alone (/cases of the file)", "NAME"};
const OptionKind overwrite{"--overwrite", &Arguments::overwrites,
                           "replace an older run of this command in the same place"};
const OptionKind overwrite_file{"--overwrite", &Arguments::overwrites,
                                "replace a file that is there"};
const OptionKind no_report{"--no-report", &Arguments::leaves_out_report,
                           "write no report.html; the command report makes it later"};
const OptionKind resume{"--resume", &Arguments::resumes,
                        "go on with the run in the folder that was killed or interrupted: its "
                        "search makes no evaluation twice",
                        "", [](CLI::Option& option) { option.excludes("--overwrite"); }};
const OptionKind design{
    "--design", &Arguments::design,
    "at the design of a result.json or failed_design.json of an optimization, or of a file "
    "{\"rod_height\": \"12 mm\", …}; an optimization begins there",
    "FILE"};
const OptionKind all_warnings{"--all-warnings", &Arguments::wants_all_warnings,
                              "show warnings that may follow from others, too"};
const OptionKind all_checks{
    "--all-checks", Scrutiny::close,
    "judge the numbers as those of an optimum: with half the step and twice the elements"};
const OptionKind no_checks{"--no-checks", Scrutiny::none,
                           "look for nothing that speaks against the numbers", "",
                           [](CLI::Option& option) { option.excludes("--all-checks"); }};
const OptionKind effects{"--effects", &Arguments::wants_effects,
                         "list all physical effects, also those that change next to nothing"};
const OptionKind accuracy{
    "--accuracy", &Arguments::accuracy,
    "relative error of what is minimized or limited, such as 0.1% (or the ratio 0.001): steps, "
    "elements and effects are chosen for it",
    "TARGET"};
const OptionKind backend{"--backend", &Arguments::backend,
                         "this optimizer alone, instead of the file's; see the command backends",
                         "NAME"};
const OptionKind starts{"--starts", &Arguments::starts,
                        "begin at so many designs, the start and others spread between the bounds",
                        "NUMBER", counts_to<10000>};
const OptionKind method{
    "--method", &Arguments::methods,
    "gradients instead of the file's: auto, direct, adjoint, forward-difference, "
    "central-difference",
    "NAME", takes_one};
const OptionKind jobs{"--jobs", &Arguments::jobs,
                      "simulations at a time (default: the environment variable PLEUEL_JOBS, or "
                      "all processors)",
                      "NUMBER", counts_to<1024>};

const OptionKind effect_costs{"--effects", &Arguments::wants_effects,
                              "show what each effect brings and costs: a simulation more for each"};
const OptionKind with_optima{
    "--optimum", &Arguments::wants_optimum,
    "at the optimum (that of --design, or it is looked for), and with whole "
    "optimizations for the settings that are worth it"};
const OptionKind sampled_histories{
    "--histories", &Arguments::wants_histories,
    "sample deviations of histories, too: run.sqlite keeps all of them"};
const OptionKind front_gap{
    "--gap", &Arguments::gap,
    "more points, until no neighbours are further apart, both goals over their "
    "ranges: such as 0.05 or 5%",
    "NUMBER"};
const OptionKind optimal_design{
    "--design", &Arguments::design,
    "the optimum: result.json of an optimization (default: it is looked for first)", "FILE"};
const OptionKind compared_methods{
    "--method", &Arguments::methods,
    "instead of the file's: auto (direct or adjoint, whichever is faster), direct, "
    "adjoint, forward-difference, central-difference; repeat to compare",
    "NAME", is_repeated};

const OptionKind difference_step{"--step", &Arguments::difference_step,
                                 "relative step of the differences instead of the file's",
                                 "NUMBER"};
const OptionKind gradient_histories{"--histories", &Arguments::wants_histories,
                                    "write the derivatives of all histories into a run folder"};
const OptionKind by_invariants{
    "--by-invariants", &Arguments::differentiated_body,
    "also derivatives by each number of this body, which is of the type \"invariants\": a "
    "finite-element program makes those by its variables of them",
    "BODY"};
const OptionKind method_comparison{
    "--compare", &Arguments::compares_methods,
    "effort and accuracy of all methods, of differences with steps from 1e-2 to 1e-8, into a run "
    "folder"};

OptionKind verbose(const std::string& what) {
  return {"--verbose", &Arguments::is_verbose,
          "print " + what + ", too; result.json and the report have them in any case"};
}

OptionKind task_limit(const std::string& task) {
  return {"--task-limit", &Arguments::task_limit,
          "seconds after which the process of " + task +
              " counts as hung; it is tried once more (default: none)",
          "SECONDS", [](CLI::Option& option) {
            option.check(CLI::Validator(
                [](const std::string& text) -> std::string {
                  double seconds = 0.0;
                  const bool is_number = CLI::detail::lexical_cast(text, seconds);
                  return is_number && seconds > 0.0 ? "" : "must be a number above 0, got " + text;
                },
                ""));
          }};
}

OptionKind output_folder(const std::string& command) {
  return {
      "-o,--output", &Arguments::output,
      "run folder (default: the first of runs/<file>-" + command + ", …-2, …-3 that is not there)",
      "DIR"};
}

OptionKind output(const std::string& description, const char* type,
                  void (*limit)(CLI::Option&) = nullptr) {
  return {"-o,--output", &Arguments::output, description, type, limit};
}

OptionKind run_folder_of() {
  return {"DIR", &Arguments::file, "run folder", "", is_required};
}

/// Of commands that take a problem file.
std::vector<OptionKind> of_problem(std::initializer_list<OptionKind> more) {
  std::vector<OptionKind> all = {json,
                                 {"FILE", &Arguments::file, "problem file (JSON)", "", is_required},
                                 overrides,
                                 programs,
                                 load_case};
  all.insert(all.end(), more);
  return all;
}

/// Of those that write a run folder.
std::vector<OptionKind> of_run(const std::string& command, std::initializer_list<OptionKind> more) {
  std::vector<OptionKind> all = of_problem({overwrite, no_report, output_folder(command)});
  all.insert(all.end(), more);
  return all;
}

}  // namespace

std::vector<CommandKind> command_kinds() {
  return {
      {"new",
       "write a small problem file to begin with; alone: list them",
       "Writes a small commented problem file that runs as it is: change it into yours. Without "
       "KIND it lists the mechanisms there are.",
       "new four-bar my/stirrer.json",
       {json,
        {"KIND", &Arguments::kind, "what mechanism: see the list"},
        {"FILE", &Arguments::file, "where to (default: KIND.json)"},
        {"--overwrite", &Arguments::overwrites, "replace files that are there"}}},
      {"show", "draw the mechanism of a file as a page, before it is simulated",
       "Writes a page (HTML) that draws the mechanism as the file places it: names, axes, "
       "sections, joints, loads over time, and what nothing holds. Only the first steps are "
       "simulated, to tell how long it takes.",
       "show pump.json -o pump.html",
       of_problem({output("the page to write, or a run folder (default: the first of "
                          "runs/<file>-show.html, …-2 that is not there)",
                          "FILE.html|DIR"),
                   overwrite, design})},
      {"simulate", "simulate one design and say whether it keeps its limits",
       "Simulates one design: the start of the file, or another one by --design or --set. Shows "
       "all responses with their errors, and whether the design keeps its limits (exit code 4 if "
       "a design of yours breaks one); writes the motion and a report into a run folder.",
       "simulate pump.json --set \"rod_diameter=12 mm\"",
       of_run("simulate", {all_warnings, all_checks, no_checks, accuracy, effect_costs, design})},
      {"optimize", "find the best design within the limits, and verify it",
       "Looks for the best design within the limits, tries to disprove it, and says VERIFIED only "
       "where that fails. Writes the design, the way to it and a report into a run folder.",
       "optimize pump.json --starts 4",
       of_run("optimize", {all_warnings, all_checks, no_checks, resume, accuracy, design,
                           verbose("the audit, prices of limits, drives and effects"), effects,
                           backend, starts, method, jobs, task_limit("one of several starts")})},
      {"check", "validate, describe the mechanism, verify the derivatives, estimate the time",
       "Examines a problem before you spend time on it: simulates the start design, tells what "
       "can move and which effects matter, compares all derivatives with differences of "
       "simulations, and says how long an optimization takes.",
       "check pump.json",
       of_problem({design, effects, all_warnings, jobs, overwrite, no_report,
                   output("run folder for result.json and report.html (default: nothing is "
                          "written)",
                          "DIR")})},
      {"accuracy", "errors and times for steps x elements; the cheapest that will do",
       "Simulates with many steps and elements, compares with a much finer reference, and "
       "recommends the cheapest setting for 1 %, 0.1 % and so on.",
       "accuracy pump.json",
       of_run("accuracy", {resume, design, with_optima,
                           verbose("the errors and times of all settings"), backend})},
      {"uncertainty", "deviations and bounds of responses; Monte Carlo as the check",
       "Tells how far the responses scatter if the numbers of /uncertainty do; samples (Monte "
       "Carlo) check the estimate by gradients.",
       "uncertainty pump.json --jobs 4",
       of_run("uncertainty",
              {design, sampled_histories, resume, accuracy, jobs, task_limit("eight samples")})},
      {"pareto", "the best designs for a row of values of one limit",
       "Optimizes for a row of values of one limit, or trades two responses: what more of one "
       "costs of the other. The file says what in /pareto.",
       "pareto pump.json",
       of_run("pareto",
              {resume, front_gap, accuracy, backend, method, jobs, task_limit("one point")})},
      {"prices", "what the optimum would gain by each number of the file",
       "Takes an optimum and tells for each number of the file what the objective would gain if "
       "it were one percent better: which limit, length or material to talk about.",
       "prices pump.json --design runs/pump-optimize/result.json",
       of_run("prices", {optimal_design, accuracy, backend, method, jobs})},
      {"gradient", "derivatives of all responses by the variables, at the start or another design",
       "Prints the derivatives of all responses with respect to all variables, by one or several "
       "methods.",
       "gradient pump.json --method direct --method adjoint",
       of_run("gradient",
              {design, compared_methods, difference_step, jobs, accuracy, all_warnings, all_checks,
               no_checks, gradient_histories, by_invariants, method_comparison})},
      {"compare",
       "two runs side by side: what differs in input and outcome",
       "Shows two runs side by side: where their inputs differ, and by how much their variables, "
       "limits, responses and effort do, in the units of the file.",
       "compare runs/pump-optimize runs/pump-optimize-2",
       {json,
        {"DIR", &Arguments::files, "the two run folders", "",
         [](CLI::Option& option) { option.required()->expected(2); }},
        output("the page to write (default: the first of runs/compare.html, …-2 that is not there)",
               "FILE.html"),
        overwrite_file,
        programs}},
      {"runs",
       "list runs: command, problem, status, objective, time",
       "Lists the runs of a folder, one a line, the newest last.",
       "runs --sort name",
       {json,
        {"DIR", &Arguments::file, "folder that holds run folders (default: runs)"},
        {"--sort", &Arguments::order, "time (default; the newest is the last) or name", "KEY",
         [](CLI::Option& option) {
           option.check(CLI::IsMember({"time", "name"}));
         }}}},
      {"report",
       "write report.html into folders of earlier runs",
       "Writes report.html into folders of runs that have none, or makes it anew.",
       "report runs/pump-optimize",
       {json, {"DIR", &Arguments::files, "run folders", "", is_required}}},
      {"plot",
       "draw histories of a run: as SVG, and in the terminal",
       "Draws the histories of responses with their limits and error bands as a picture (SVG), "
       "and in the terminal. Without NAME it lists the histories.",
       "plot runs/pump-optimize rod_stress",
       {json,
        run_folder_of(),
        {"NAME", &Arguments::names,
         "responses with histories (default: the names of all are listed)"},
        output("the drawing to write (default: DIR/plot-NAME.svg, or plot.svg of several)",
               "FILE.svg"),
        overwrite_file}},
      {"export",
       "write the evaluations of optimize or pareto as tables (CSV)",
       "Writes every evaluation of an optimization as tables; with --vtk also the motion of start "
       "and optimum.",
       "export runs/pump-optimize --vtk",
       {json,
        run_folder_of(),
        output("where the files go (default: the run folder)", "DIR"),
        programs,
        {"--vtk", &Arguments::wants_vtk,
         "write the motion of start and optimum for ParaView, too, which are simulated again"}}},
      {"stability",
       "drift, energy and work of files x formulations and schemes",
       "Simulates each file with all formulations of the constraints and all schemes, and "
       "compares drift, energy and work.",
       "stability pump.json press.json",
       {json,
        {"FILE", &Arguments::files, "problem files (JSON)", "", is_required},
        overrides,
        programs,
        load_case,
        overwrite,
        no_report,
        output_folder("stability")}},
      {"invariants", "write what the mechanics knows of elastic bodies, with derivatives",
       "Writes the constants of the elastic bodies (mass, stiffness, coupling terms and their "
       "derivatives) as files that other codes can read.",
       "invariants pump.json --body rod -o rod.json",
       of_problem(
           {{"--body", &Arguments::body, "this body only (default: all elastic ones)", "NAME"},
            output("a file NAME.json, or a run folder (default: runs/<file>-invariants)", "PATH"),
            overwrite})},
      {"reduce",
       "make a body of a finite-element model of a solid",
       "Takes mesh, stiffness and mass matrix of a solid from a finite-element program, and "
       "writes the few numbers that a mechanism knows the body by, for bodies of the type "
       "\"invariants\".",
       "reduce rod_model.json -o rod.json",
       {json,
        {"FILE", &Arguments::file, "model file (JSON)", "", is_required},
        output("the file of invariants to write", "FILE.json", is_required),
        overwrite}},
      {"backends",
       "list the optimizers",
       "Lists the optimizers, and when to take which.",
       "backends",
       {json}},
      {"schema",
       "print or write the JSON schema of problem files, by which editors complete",
       "Editors that know JSON schemas complete and check problem files by it.",
       "schema problem.schema.json",
       {json, {"FILE", &Arguments::file, "where to (default: standard output)"}, overwrite_file}},
      {"completion",
       "print the completion of commands and options for a shell",
       "Prints what the shell has to read so that the Tab key completes commands and options.",
       "completion bash > ~/.local/share/bash-completion/completions/pleuel",
       {json, {"SHELL", &Arguments::kind, "bash or zsh", "", is_required}}}};
}

}  // namespace pleuel
