#include "optimization/design_solve.hpp"

#include "optimization/peak_problem.hpp"

namespace pleuel {

namespace {

/// Windows of time for each limit on a peak: short enough to part the peaks of one motion.
constexpr int peak_windows = 16;

}  // namespace

Result solve_design(DesignProblem& problem, const SolveOptions& options, const Observer& observer) {
  PeakProblem peaks(problem, peak_windows);
  const auto fold = [&](EvaluationRecord record) {
    if (record.constraints.size() > 0) record.constraints = peaks.fold_values(record.constraints);
    return record;
  };
  Observer folding;
  if (observer) folding = [&](const EvaluationRecord& record) { observer(fold(record)); };
  Result result = solve(peaks, options, folding);
  for (EvaluationRecord& record : result.history) record = fold(std::move(record));
  if (result.constraint_multipliers.size() > 0) {
    result.constraint_multipliers = peaks.fold_multipliers(result.constraint_multipliers);
  }
  // The last design on the constraints of the file.
  if (result.evaluation.has_gradients()) {
    result.evaluation = problem.evaluate(result.x, Request::values_and_gradients);
  }
  return result;
}

}  // namespace pleuel
