#include "optimization/design_solve.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "optimization/peak_problem.hpp"
#include "optimization/robust_problem.hpp"
#include "optimization/verdict.hpp"
#include "sensitivity/gradients.hpp"

namespace pleuel {

namespace {

/// Windows of time for each limit on a peak: short enough to part the peaks of one motion.
constexpr int peak_windows = 16;
/// Iterations after which a run on the constraints of the file is taken for one that does not end:
/// on a smooth optimum all backends need fewer.
constexpr int plain_iterations = 40;

/// Counts on from an earlier run.
EvaluationRecord continued(EvaluationRecord record, const Result& before) {
  record.evaluation += before.evaluations;
  record.iteration += before.iterations;
  record.seconds += before.seconds;
  return record;
}

void continue_from(const Result& before, Result& result) {
  result.evaluations += before.evaluations;
  result.gradient_evaluations += before.gradient_evaluations;
  result.iterations += before.iterations;
  result.restarts += before.restarts + 1;
  result.seconds += before.seconds;
  result.history.insert(result.history.begin(), before.history.begin(), before.history.end());
}

/// With the margins that the constraints of the file ask for, if any.
/// @param constraint_of_row  of a problem made of that of the file
/// @throws InputError if gradients are differences: those of differences would be noise
std::unique_ptr<Problem> with_margins(Problem& problem, const DesignProblem& design,
                                      const std::vector<std::size_t>& constraint_of_row) {
  Eigen::VectorXd margins(static_cast<Eigen::Index>(constraint_of_row.size()));
  for (std::size_t row = 0; row < constraint_of_row.size(); ++row) {
    margins(static_cast<Eigen::Index>(row)) =
        design.file().constraints[constraint_of_row[row]].deviations;
  }
  if (margins.isZero(0.0)) return nullptr;
  if (is_difference(design.file().sensitivity.method)) {
    throw InputError(
        "/sensitivity/method must be \"auto\", \"direct\" or \"adjoint\" where a constraint has "
        "\"deviations\": their gradients are differences of gradients");
  }
  return std::make_unique<RobustProblem>(problem, design.variable_deviations(), margins);
}

/// On the peaks of windows, beginning where the run on whole constraints ended (if that is within
/// the limits).
Result solve_peaks(DesignProblem& design, const SolveOptions& options, const Result& before,
                   const Observer& observer) {
  PeakProblem peaks(design, peak_windows);
  if (before.status == Status::stalled) peaks.start_from(before.x);
  const auto fold = [&](EvaluationRecord record) {
    if (record.constraints.size() > 0) record.constraints = peaks.fold_values(record.constraints);
    return continued(std::move(record), before);
  };
  Observer folding;
  if (observer) folding = [&](const EvaluationRecord& record) { observer(fold(record)); };
  const auto robust = with_margins(peaks, design, peaks.constraint_of_row());
  Result result = solve(robust ? *robust : peaks, options, folding);
  for (EvaluationRecord& record : result.history) record = fold(std::move(record));
  if (result.constraint_multipliers.size() > 0) {
    result.constraint_multipliers = peaks.fold_multipliers(result.constraint_multipliers);
  }
  if (result.evaluation.has_gradients()) {
    const Eigen::VectorXd rows = result.evaluation.constraints;
    result.evaluation = design.evaluate(result.x, Request::values_and_gradients);
    result.evaluation.constraints = peaks.fold_values(rows);
  }
  return result;
}

/// Whether all peaks keep their margins: a lower one may scatter more than the highest.
bool keeps_margins(DesignProblem& design, const Eigen::VectorXd& x, double tolerance) {
  PeakProblem peaks(design, peak_windows);
  const auto robust = with_margins(peaks, design, peaks.constraint_of_row());
  const Eigen::VectorXd rows = robust->evaluate(x, Request::values).constraints;
  const Eigen::VectorXd values = peaks.fold_values(rows);
  for (std::size_t i = 0; i < design.constraints().size(); ++i) {
    const Constraint& constraint = design.constraints()[i];
    const double value = values(static_cast<Eigen::Index>(i));
    const double excess = std::max(value - constraint.upper, constraint.lower - value);
    if (excess > tolerance * std::abs(value)) return false;
  }
  return true;
}

}  // namespace

Result solve_design(DesignProblem& design, const SolveOptions& options, const Observer& observer) {
  std::vector<std::size_t> all(design.constraints().size());
  std::iota(all.begin(), all.end(), 0u);
  const auto robust = with_margins(design, design, all);
  Problem& problem = robust ? *robust : design;
  SolveOptions plain = options;
  plain.max_iterations = std::min(options.max_iterations, plain_iterations);
  plain.max_restarts = std::min(options.max_restarts, 1);
  Result result = solve(problem, plain, observer);
  SolveOptions rest = options;
  rest.max_iterations = options.max_iterations - result.iterations;
  const bool is_verified = result.status == Status::verified &&
                           (!robust || keeps_margins(design, result.x, Tolerances().violation));
  const bool is_final = is_verified || result.status == Status::failed;
  if (is_final || rest.max_iterations < 1) return result;
  Result on_peaks = solve_peaks(design, rest, result, observer);
  continue_from(result, on_peaks);
  return on_peaks;
}

}  // namespace pleuel
