#include "cli/input/help_texts.hpp"

#include <map>

#include <fmt/format.h>

#include "cli/text/wrapped_text.hpp"

namespace pleuel {

namespace {

struct HelpText {
  const char *does, *example;
};

/// The program is called {0}.
const std::map<std::string, HelpText>& help_texts() {
  static const std::map<std::string, HelpText> texts = {
      {"new",
       {"Writes a small commented problem file that runs as it is: change it into yours. Without "
        "KIND it lists the mechanisms there are.",
        "{0} new four-bar my/stirrer.json"}},
      {"check",
       {"Examines a problem before you spend time on it: simulates the start design, tells what "
        "can "
        "move and which effects matter, compares all derivatives with differences of simulations, "
        "and says how long an optimization takes.",
        "{0} check pump.json"}},
      {"show",
       {"Writes a page (HTML) that draws the mechanism as the file places it: names, axes, "
        "sections, "
        "joints, loads over time, and what nothing holds. Only the first steps are simulated, to "
        "tell how long it takes.",
        "{0} show pump.json -o pump.html"}},
      {"simulate",
       {"Simulates one design: the start of the file, or another one by --design or --set. Shows "
        "all "
        "responses with their errors, and whether the design keeps its limits (exit code 4 if "
        "a design of yours breaks one); writes the motion and a report into a run folder.",
        "{0} simulate pump.json --set \"rod_diameter=12 mm\""}},
      {"gradient",
       {"Prints the derivatives of all responses with respect to all variables, by one or several "
        "methods.",
        "{0} gradient pump.json --method direct --method adjoint"}},
      {"invariants",
       {"Writes the constants of the elastic bodies (mass, stiffness, coupling terms and their "
        "derivatives) as files that other codes can read.",
        "{0} invariants pump.json --body rod -o rod.json"}},
      {"reduce",
       {"Takes mesh, stiffness and mass matrix of a solid from a finite-element program, and "
        "writes "
        "the few numbers that a mechanism knows the body by, for bodies of the type "
        "\"invariants\".",
        "{0} reduce rod_model.json -o rod.json"}},
      {"optimize",
       {"Looks for the best design within the limits, tries to disprove it, and says VERIFIED only "
        "where that fails. Writes the design, the way to it and a report into a run folder.",
        "{0} optimize pump.json --starts 4"}},
      {"pareto",
       {"Optimizes for a row of values of one limit, or trades two responses: what more of one "
        "costs "
        "of the other. The file says what in /pareto.",
        "{0} pareto pump.json"}},
      {"prices",
       {"Takes an optimum and tells for each number of the file what the objective would gain if "
        "it "
        "were one percent better: which limit, length or material to talk about.",
        "{0} prices pump.json --design runs/pump-optimize/result.json"}},
      {"accuracy",
       {"Simulates with many steps and elements, compares with a much finer reference, and "
        "recommends the cheapest setting for 1 %, 0.1 % and so on.",
        "{0} accuracy pump.json"}},
      {"stability",
       {"Simulates each file with all formulations of the constraints and all schemes, and "
        "compares "
        "drift, energy and work.",
        "{0} stability pump.json press.json"}},
      {"uncertainty",
       {"Tells how far the responses scatter if the numbers of /uncertainty do; samples (Monte "
        "Carlo) check the estimate by gradients.",
        "{0} uncertainty pump.json --jobs 4"}},
      {"runs",
       {"Lists the runs of a folder, one a line, the newest last.", "{0} runs --sort name"}},
      {"compare",
       {"Shows two runs side by side: where their inputs differ, and by how much their variables, "
        "limits, responses and effort do, in the units of the file.",
        "{0} compare runs/pump-optimize runs/pump-optimize-2"}},
      {"export",
       {"Writes every evaluation of an optimization as tables; with --vtk also the motion of start "
        "and optimum.",
        "{0} export runs/pump-optimize --vtk"}},
      {"report",
       {"Writes report.html into folders of runs that have none, or makes it anew.",
        "{0} report runs/pump-optimize"}},
      {"plot",
       {"Draws the histories of responses with their limits and error bands as a picture (SVG), "
        "and "
        "in the terminal. Without NAME it lists the histories.",
        "{0} plot runs/pump-optimize rod_stress"}},
      {"backends", {"Lists the optimizers, and when to take which.", "{0} backends"}},
      {"schema",
       {"Editors that know JSON schemas complete and check problem files by it.",
        "{0} schema problem.schema.json"}},
      {"completion",
       {"Prints what the shell has to read so that the Tab key completes commands and options.",
        "{0} completion bash > ~/.local/share/bash-completion/completions/pleuel"}}};
  return texts;
}

}  // namespace

std::string help_text(const std::string& command) {
  const auto found = help_texts().find(command);
  if (found == help_texts().end()) return "";
  const auto& [does, example] = found->second;
  return wrapped(
      fmt::format("\n{}\n\nExample:\n  {}", does, fmt::format(fmt::runtime(example), "pleuel")));
}

}  // namespace pleuel
