#include "optimization/design/design_solve.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/response/divided_deflection.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/response_parts.hpp"
#include "core/trust/refined_runs.hpp"
#include "optimization/design/margin_problem.hpp"
#include "optimization/design/number_judgement.hpp"
#include "optimization/design/peak_problem.hpp"
#include "optimization/design/peak_windows.hpp"
#include "optimization/kkt_audit.hpp"
#include "optimization/linear_choice.hpp"
#include "optimization/result.hpp"
#include "optimization/scaling.hpp"

namespace pleuel {

namespace {

/// Windows of time for each limit on a peak: short enough to part the peaks of one motion; and if
/// they are not, as the simulation takes in many periods.
constexpr int peak_windows = 16;
constexpr int most_windows = 128;
/// Where the limits alone count: designs far outside vibrate.
constexpr int windows_of_limits = 64;
/// Iterations after which a run on the constraints of the file is taken for one that does not end:
/// on a smooth optimum all backends need fewer.
constexpr int plain_iterations = 40;
/// The same where the objective is the largest of several responses: two of them meet at its optimum,
/// more often than not.
constexpr int iterations_of_extreme = 8;

/// Records of a run on windows as records of the file, one after the other.
class Folding {
 public:
  /// @param before      the design before the first record
  /// @param first       that scales variables
  /// @param evaluation  that scales constraints
  Folding(const PeakProblem& peaks, const DesignProblem& design, const Eigen::VectorXd& before,
          const Eigen::VectorXd& first, const Evaluation& evaluation)
      : peaks_(peaks), design_(design), last_(before) {
    variable_scales_ = variable_scales(design, first);
    constraint_scales_ = constraint_scales(design, evaluation, variable_scales_);
  }

  EvaluationRecord folded(EvaluationRecord record) {
    record.x = peaks_.design_of(record.x);
    record.step = (record.x - last_).cwiseQuotient(variable_scales_).lpNorm<Eigen::Infinity>();
    last_ = record.x;
    if (!record.has_failed()) {
      record.objective = peaks_.fold_objective(record.objective, record.constraints);
      record.constraints = peaks_.fold_values(record.constraints);
      record.max_violation = violation(record.constraints);
    }
    return record;
  }

  /// Of the constraints of the file.
  double violation(const Eigen::VectorXd& constraints) const {
    return max_violation(design_, constraints, constraint_scales_);
  }

 private:
  const PeakProblem& peaks_;
  const DesignProblem& design_;
  Eigen::VectorXd last_, variable_scales_, constraint_scales_;
};

void fold_result(const PeakProblem& peaks, const Folding& folding, DesignProblem& design,
                 Result& result) {
  result.x = peaks.design_of(result.x);
  if (!result.evaluation.has_gradients()) return;
  const Eigen::VectorXd rows = result.evaluation.constraints;
  result.evaluation = design.evaluate(result.x, Request::values_and_gradients);
  result.evaluation.constraints = peaks.fold_values(rows);
  result.max_violation = folding.violation(result.evaluation.constraints);
  result.case_shares = peaks.objective_shares(result.constraint_multipliers);
  result.constraint_multipliers = peaks.fold_multipliers(result.constraint_multipliers);
  result.bound_multipliers = peaks.design_of(result.bound_multipliers);
}

/// A run of a backend on peaks as one on the file.
Result solve_folded(PeakProblem& peaks, DesignProblem& design, const SolveOptions& options,
                    const Observer& observer, Folding folding) {
  const auto robust = with_margins(peaks, design, peaks.constraint_of_row());
  Result result = run_with_records(
      [&](EvaluationRecord record) { return folding.folded(std::move(record)); }, observer,
      [&](const Observer& hears) { return solve(robust ? *robust : peaks, options, hears); });
  fold_result(peaks, folding, design, result);
  return result;
}

/// On the peaks of windows, beginning where the run on whole constraints ended (if that is within
/// the limits).
Result solve_peaks(DesignProblem& design, int windows, const SolveOptions& options,
                   const Result& before, const Observer& observer) {
  PeakProblem peaks = before.status == Status::stalled ? PeakProblem(design, windows, before.x)
                                                       : PeakProblem(design, windows);
  const History& history = before.history;
  Result result =
      solve_folded(peaks, design, options, observer,
                   {peaks, design, history.back().x, history.front().x, before.evaluation});
  if (peaks.divides_time()) {
    result.message += fmt::format("; peaks over time were told apart by {} windows", windows);
  }
  return result;
}

/// Whether the objective is the largest of several responses, or the smallest that is maximized.
bool has_extreme_objective(const DesignProblem& design) {
  const Extreme extreme =
      design.file().objective->aim == Aim::maximize ? Extreme::smallest : Extreme::largest;
  if (!design.has_objective_in_cases()) {
    return !extreme_parts(design.file(), design.objective_response(), extreme).empty();
  }
  const DesignCase& first = design.load_case(0);
  return !extreme_parts(first.file(), *first.response_of({}), extreme).empty();
}

/// On the constraints of the file. The worst of several cases is bounded by a variable, as there is
/// a kink at nearly every optimum where two of them tie.
Result solve_plainly(DesignProblem& design, Problem& problem, const SolveOptions& options,
                     const Observer& observer) {
  const bool has_extreme = !design.has_objective_in_cases() && has_extreme_objective(design);
  if (!design.minimizes_worst() && !has_extreme) return solve(problem, options, observer);
  const Eigen::VectorXd start = checked_start(design);
  const Attempt first = attempt_evaluation(design, start, Request::values_and_gradients);
  if (!first.evaluation) return solve(problem, options, observer);  // tells why it cannot begin
  PeakProblem bounded(design, 1, start);
  return solve_folded(bounded, design, options, observer,
                      {bounded, design, start, start, *first.evaluation});
}

/// Whether all peaks keep their margins: a lower one may scatter more than the highest.
bool keeps_margins(DesignProblem& design, const Eigen::VectorXd& x, double tolerance) {
  PeakProblem peaks(design, peak_windows, x);
  const auto robust = with_margins(peaks, design, peaks.constraint_of_row());
  const Eigen::VectorXd rows =
      robust->evaluate(checked_start(*robust), Request::values).constraints;
  const Eigen::VectorXd values = peaks.fold_values(rows);
  for (std::size_t i = 0; i < design.constraints().size(); ++i) {
    const double value = values(i);
    if (design.constraints()[i].excess(value) > tolerance * std::abs(value)) return false;
  }
  return true;
}

/// Why the run on the file as it is does not do.
std::string reason_to_go_on(const Result& result, DesignProblem& design) {
  if (result.status == Status::verified) return "other peaks do not keep their margins";
  const std::string tie = tying_peaks(design, result.x);
  return tie.empty() ? "no optimum is verified so far" : tie;
}

/// The limits are so far away that windows of time are no way to them.
constexpr double far_outside = 0.1;

bool ends_far_outside(const Result& result) {
  return result.status == Status::infeasible && result.max_violation > far_outside;
}

/// The problem of the file with its margins; none if it has none.
std::unique_ptr<Problem> robust_problem(DesignProblem& design) {
  return with_margins(design, design, own_constraints(design));
}

/// From the start of the design problem, with one backend.
Result attempt_optimum(DesignProblem& design, const SolveOptions& options, const Observer& observer,
                       const Notice& notice) {
  const auto robust = robust_problem(design);
  Problem& problem = robust ? *robust : design;
  SolveOptions plain = options;
  plain.max_iterations =
      std::min(options.max_iterations,
               has_extreme_objective(design) ? iterations_of_extreme : plain_iterations);
  plain.polish_iterations =
      std::min(plain_iterations / 2, options.max_iterations - plain.max_iterations);
  plain.max_restarts = std::min(options.max_restarts, 1);
  Result result = solve_plainly(design, problem, plain, observer);
  SolveOptions rest = options;
  rest.max_iterations = options.max_iterations - result.iterations;
  rest.earlier = {options.earlier.iterations + result.iterations,
                  options.earlier.restarts + result.restarts + 1};
  const bool is_verified = result.status == Status::verified &&
                           (!robust || keeps_margins(design, result.x, Tolerances().violation));
  if (is_verified || result.status == Status::failed || ends_far_outside(result)) return result;
  if (rest.max_iterations >= 1) {
    const int windows = windows_that_part_peaks(design, result.x, peak_windows, most_windows);
    notify(notice, fmt::format("{}: from here on the peaks of {} windows of time count one by one",
                               reason_to_go_on(result, design), windows));
    result = run_after(result, observer, [&](const Observer& hears) {
      return solve_peaks(design, windows, rest, result, hears);
    });
    ++result.restarts;
  }
  if (result.status == Status::stalled) {
    for (const auto& advice :
         {tying_peaks(design, result.x), advise_on_meeting_frequencies(design, result.x)}) {
      if (!advice.empty()) result.message += "; " + advice;
    }
  }
  return result;
}

/// find_optimum() with attempts on the file as it is and on windows of time; the rows of the limits are windows.
Result search_design_alone(DesignProblem& design, const SolveOptions& options,
                           const Observer& observer, const Notice& notice) {
  const auto robust = robust_problem(design);
  const auto attempt = [&](const Eigen::VectorXd& start, const SolveOptions& with,
                           const Observer& hears) {
    design.start_from(start);
    return attempt_optimum(design, with, hears, notice);
  };
  std::unique_ptr<PeakProblem> peaks;
  std::unique_ptr<Problem> robust_peaks;
  const auto limit_rows = [&] {
    peaks = std::make_unique<PeakProblem>(design, windows_of_limits, start_of(design),
                                          PeakProblem::Scope::limits);
    robust_peaks = with_margins(*peaks, design, peaks->constraint_of_row());
    return LimitRows{robust_peaks ? robust_peaks.get() : peaks.get(), peaks->constraint_of_row()};
  };
  Problem& problem = robust ? *robust : design;
  return find_optimum({problem, attempt, limit_rows}, options, observer, notice);
}

/// The violation up to which one design is preferred to another for its objective: so that no
/// tolerance is exploited.
constexpr double strict_violation = 1e-6;

/// A run that proved nothing ends at the best design of its whole history: a later part of the run
/// may have begun at a worse one.
void return_to_best(DesignProblem& design, const Tolerances& tolerances, Result& result) {
  if (result.status == Status::verified || !result.evaluation.has_gradients()) return;
  if (result.least_violation) return;  // the least that was seen or found
  const bool keeps_limits = result.max_violation <= tolerances.violation;
  const EvaluationRecord best = best_record(result.history, strict_violation);
  const bool is_better = keeps_limits ? best.max_violation <= strict_violation &&
                                            best.objective < result.evaluation.objective
                                      : best.max_violation < result.max_violation;
  if (!is_better) return;
  Attempt attempt = attempt_evaluation(design, best.x, Request::values_and_gradients);
  if (!attempt.evaluation) return;
  Evaluation& evaluation = *attempt.evaluation;
  evaluation.constraints = best.constraints;  // with their margins
  const Eigen::VectorXd scales =
      constraint_scales(design, evaluation, variable_scales(design, best.x));
  set_unproven_answer(result, design, {best.x, std::move(evaluation), best.max_violation}, scales);
  const bool is_within = best.max_violation <= tolerances.violation;
  const std::string what =
      is_within ? std::string("the best design of the run, of which nothing is proven")
                : fmt::format(
                      "no design that keeps all limits was found; of those seen, this one breaks "
                      "them least ({:.2g} relative): {}",
                      best.max_violation,
                      broken_limits(design, best.constraints, scales, tolerances.violation));
  result.message =
      is_within ? fmt::format("{}; the run ended elsewhere, where {}", what, result.message) : what;
  if (result.status != Status::failed) {
    result.status = is_within ? Status::stalled : Status::infeasible;
  }
}

Result run_with_setting(const ProblemFile& file, const Observer& observer, const ObservedRun& run) {
  return run_with_records(
      [&](EvaluationRecord record) { return simulated_with(file, std::move(record)); }, observer,
      run);
}

/// @throws InputError  naming the linear limits of a file that contradict each other or the bounds of its
///                     variables (linear_choice.hpp)
void require_linear_limits(const ProblemFile& file) {
  std::vector<const ConstraintSettings*> linear;
  for (const ConstraintSettings& limit : file.constraints) {
    if (!limit.linear.empty()) linear.push_back(&limit);
  }
  if (linear.empty()) return;
  constexpr double none = std::numeric_limits<double>::infinity();
  const Eigen::Index count = std::ssize(linear), variables = std::ssize(file.variables);
  LinearLimits limits{Eigen::MatrixXd::Zero(count, variables), Eigen::VectorXd(count),
                      Eigen::VectorXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    for (const auto& [variable, factor] : linear[i]->linear) limits.rows(i, variable) += factor;
    limits.lower(i) = linear[i]->lower.value_or(-none);
    limits.upper(i) = linear[i]->upper.value_or(none);
  }
  Eigen::VectorXd lower(variables), upper(variables);
  for (Eigen::Index k = 0; k < variables; ++k) {
    lower(k) = file.variables[k].lower;
    upper(k) = file.variables[k].upper;
  }
  std::vector<std::string> names;
  for (const std::size_t i : linear_conflict(limits, lower, upper)) {
    names.push_back(linear[i]->name);
  }
  if (names.empty()) return;
  throw InputError(
      fmt::format("/constraints: no design within the bounds of the variables keeps the linear "
                  "limit{} \"{}\"{}",
                  names.size() == 1 ? "" : "s", fmt::join(names, "\", \""),
                  names.size() == 1 ? "" : " together"));
}

}  // namespace

EvaluationRecord simulated_with(const ProblemFile& file, EvaluationRecord record) {
  record.time_step = file.simulation.step;
  record.elements = beam_elements(file);
  for (const ProblemFile& one : file.cases) {
    record.time_step = std::min(record.time_step, one.simulation.step);
    record.elements = std::max(record.elements, beam_elements(one));
  }
  return record;
}

Result search_with_setting(DesignProblem& design, const SolveOptions& options,
                           const Observer& observer) {
  return run_with_setting(design.file(), observer,
                          [&](const Observer& hears) { return search(design, options, hears); });
}

Result judge_design(DesignProblem& design, const SolveOptions& options, const Observer& observer) {
  const auto robust = robust_problem(design);
  Result result = run_with_setting(design.file(), observer, [&](const Observer& hears) {
    return solve(robust ? *robust : design, options, hears);
  });
  judge_numbers(design, options.checks_numbers ? Scrutiny::close : Scrutiny::none, result);
  return result;
}

Result solve_design(DesignProblem& design, const SolveOptions& options, const Observer& observer,
                    const Notice& notice) {
  require_linear_limits(design.file());
  Result result = run_with_setting(design.file(), observer, [&](const Observer& hears) {
    return search_design_alone(design, options, hears, notice);
  });
  return_to_best(design, options.verdict, result);
  judge_numbers(design, options.checks_numbers ? Scrutiny::close : Scrutiny::none, result);
  return result;
}

}  // namespace pleuel
