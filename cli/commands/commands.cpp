#include "cli/commands/commands.hpp"

#include "cli/reports/setting_report.hpp"

namespace pleuel {

namespace {

SettingChoice chosen_for(const ProblemFile& problem, const ProblemInput& input) {
  return choose_setting_and_effects(problem, input.design, input.problem.accuracy.target,
                                    coarse_setting(problem), JudgedBy::this_choice);
}

}  // namespace

ProblemInput read_input_with_accuracy(const Arguments& arguments) {
  ProblemInput input = read_input(arguments);
  if (!input.problem.accuracy.chooses_setting || input.problem.responses.empty()) return input;
  for (ProblemFile& one : input.problem.cases) {
    const SettingChoice choice = chosen_for(one, input);
    one = choice.problem;
    show(arguments.progress(),
         fmt::format("Case \"{}\": {}\n", one.load_case, setting_text(one, choice)));
  }
  if (input.problem.has_cases()) return input;
  input.choice = chosen_for(input.problem, input);
  input.problem = input.choice->problem;
  show(arguments.progress(), setting_text(input.problem, *input.choice) + "\n");
  return input;
}

}  // namespace pleuel
