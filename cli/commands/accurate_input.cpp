#include "cli/commands/accurate_input.hpp"

#include "cli/reports/setting_report.hpp"
#include "cli/text/console.hpp"

namespace pleuel {

ProblemInput read_input_with_accuracy(const Arguments& arguments) {
  ProblemInput input = read_input(arguments);
  if (!input.problem.accuracy.chooses_setting || input.problem.responses.empty()) return input;
  input.choice =
      choose_setting_and_effects(input.problem, input.design, input.problem.accuracy.target,
                                 coarse_setting(input.problem), JudgedBy::this_choice);
  input.problem = input.choice->problem;
  show(arguments.progress(), setting_text(input.problem, *input.choice) + "\n");
  return input;
}

}  // namespace pleuel
