#include "studies/sized_search.hpp"

#include <memory>
#include <utility>

#include "core/jobs/parallel.hpp"
#include "optimization/design/design_solve.hpp"
#include "optimization/design/size_choice.hpp"

namespace pleuel {

SizedDesign search_with_sizes(const ProblemFile& file, const SolveOptions& options,
                              EvaluationStore* store) {
  StagedSolution solution;
  solution.problem = std::make_unique<DesignProblem>(file, available_threads(), store);
  solution.result = solve_design(*solution.problem, options);
  if (!has_choices(file)) return {std::move(solution.result), std::move(solution.problem), {}, {}};
  const Execution here = {{.jobs = available_threads()}, store};
  const SizeChoiceReport report = choose_sizes(solution, options, here);
  if (!report.is_choice && solution.result.evaluation.has_gradients()) {
    solution.result.status = Status::failed;
    solution.result.message = "no choice of sizes could be simulated";
    solution.result.evaluation = {};
  }
  const TriedSizes sizes = {report.combinations, report.tried, report.is_exhaustive,
                            report.penalty(solution.result.evaluation.objective)};
  return {std::move(solution.result), std::move(solution.problem), report.relaxed_x, sizes};
}

}  // namespace pleuel
