#include "optimization/solve.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "optimization/optimizer.hpp"
#include "optimization/scaling.hpp"

namespace pleuel {

namespace {

using Clock = std::chrono::steady_clock;

void check_backend(const Problem& problem, const SolveOptions& options) {
  const auto backend = make_optimizer(options.backend, {options.tolerance});
  for (const Constraint& constraint : problem.constraints()) {
    if (constraint.is_equality() && !backend->takes_equalities()) {
      throw InputError(fmt::format(
          "{} knows no equality constraints, but {} must equal {}; use nlopt-slsqp or ipopt",
          options.backend, constraint.name, constraint.upper));
    }
  }
}

Result failed_start(const Problem& problem, const Eigen::VectorXd& x, const std::string& failure,
                    const std::string& backend, const EvaluationCache::Watch& watch) {
  EvaluationRecord record;
  record.evaluation = 1;
  record.request = Request::values_and_gradients;
  record.x = x;
  record.failure = failure;
  record.seconds = std::chrono::duration<double>(Clock::now() - watch.begin).count();
  if (watch.observer) watch.observer(record);

  Result result;
  result.message = fmt::format("the start cannot be evaluated: {} (at {})", failure,
                               describe_design(problem, x));
  result.backend = backend;
  result.x = x;
  result.evaluations = result.gradient_evaluations = 1;
  result.seconds = record.seconds;
  result.history.push_back(std::move(record));
  return result;
}

EvaluationCache make_cache(Problem& problem, const KnownDesign& start,
                           EvaluationCache::Watch watch) {
  const Eigen::VectorXd variables = variable_scales(problem, start.x);
  const Eigen::VectorXd constraints = constraint_scales(problem, start.evaluation, variables);
  return EvaluationCache(problem, start, {variables, constraints}, std::move(watch));
}

/// One optimization from a start that could be evaluated.
class Run {
 public:
  Run(EvaluationCache& cache, const SolveOptions& options)
      : cache_(cache), options_(options), start_(cache.best()) {}

  Result solve() {
    double tolerance = options_.tolerance;
    Verdict verdict = improve(start_, tolerance);
    while (verdict.status != Status::verified && may_restart()) {
      ++restarts_;
      tolerance *= tolerance_factor;
      verdict = improve(verdict.design, tolerance);
    }
    return make_result(std::move(verdict));
  }

 private:
  static constexpr double tolerance_factor = 0.1;

  /// Where the backend comes to from this design, or the best design seen so far if that is better:
  /// a backend may stop slightly outside the limits, or leave a good point.
  Verdict improve(const KnownDesign& from, double tolerance) {
    const Eigen::VectorXd end = run_backend(from, tolerance);
    const std::optional<Verdict> answer = audit(end);
    if (answer && is_clean(*answer)) return *answer;
    const std::optional<Verdict> best = audit(cache_.best().x);
    if (answer && (!best || is_better(*answer, *best))) return *answer;
    return best ? *best : judge(cache_, from, start_.evaluation, options_.verdict);
  }

  Eigen::VectorXd run_backend(const KnownDesign& from, double tolerance) {
    ScaledProblem scaled(cache_, from,
                         {options_.max_iterations, options_.max_consecutive_failures});
    if (scaled.variables() == 0) return from.x;
    const BackendEnd end = make_optimizer(options_.backend, {tolerance})->minimize(scaled);
    scaled.rethrow();
    backend_reason_ = end.reason;
    is_lost_ = cache_.consecutive_failures() >= options_.max_consecutive_failures;
    return scaled.to_design(end.y);
  }

  /// nullopt if the design, or its gradients, cannot be evaluated.
  std::optional<Verdict> audit(const Eigen::VectorXd& x) {
    const Evaluation* evaluation = cache_.evaluate(x, Request::values_and_gradients);
    if (evaluation == nullptr) return std::nullopt;
    const KnownDesign design{
        x, *evaluation,
        max_violation(cache_.problem(), evaluation->constraints, cache_.scales().constraints)};
    return judge(cache_, design, start_.evaluation, options_.verdict);
  }

  /// Proven, and within the limits by the measure that makes a design the best one seen.
  static bool is_clean(const Verdict& answer) {
    return answer.status == Status::verified && answer.design.max_violation <= strict_feasibility;
  }

  static bool is_better(const Verdict& answer, const Verdict& best) {
    if (best.status == Status::verified) return false;
    if (answer.status == Status::verified) return true;
    const bool keeps_limits = answer.status != Status::infeasible;
    return keeps_limits && answer.design.evaluation.objective < best.design.evaluation.objective;
  }

  bool is_exhausted() const { return cache_.iterations() >= options_.max_iterations; }

  bool may_restart() const {
    return restarts_ < options_.max_restarts && !is_exhausted() && !is_lost_;
  }

  Result make_result(Verdict verdict) const {
    Result result;
    result.status = verdict.status;
    result.message = verdict.message;
    if (verdict.status != Status::verified) add_reason(result);
    result.backend = options_.backend;
    result.x = std::move(verdict.design.x);
    result.evaluation = std::move(verdict.design.evaluation);
    result.constraint_multipliers = std::move(verdict.audit.constraint_multipliers);
    result.bound_multipliers = std::move(verdict.audit.bound_multipliers);
    result.kkt_residual = verdict.audit.residual;
    result.max_violation = verdict.design.max_violation;
    result.evaluations = cache_.evaluations();
    result.gradient_evaluations = cache_.gradient_evaluations();
    result.iterations = cache_.iterations();
    result.restarts = restarts_;
    result.seconds = cache_.seconds();
    result.history = cache_.history();
    return result;
  }

  /// Why the search for an optimum ended where it did.
  void add_reason(Result& result) const {
    if (is_lost_) {
      const EvaluationRecord& last = last_failure();
      result.status = Status::failed;
      result.message = fmt::format("{} evaluations in a row failed, the last with: {} (at {}); {}",
                                   options_.max_consecutive_failures, last.failure,
                                   describe_design(cache_.problem(), last.x), result.message);
    } else if (is_exhausted()) {
      result.message += fmt::format("; all {} iterations are used", options_.max_iterations);
    } else {
      result.message += fmt::format("; {} said after {} restarts: {}", options_.backend, restarts_,
                                    backend_reason_);
    }
  }

  const EvaluationRecord& last_failure() const {
    const History& history = cache_.history();
    return *std::find_if(history.rbegin(), history.rend(),
                         [](const EvaluationRecord& record) { return !record.failure.empty(); });
  }

  EvaluationCache& cache_;
  const SolveOptions& options_;
  const KnownDesign start_;
  int restarts_ = 0;
  bool is_lost_ = false;
  std::string backend_reason_ = "nothing, since no variable is free";
};

}  // namespace

Result solve(Problem& problem, const SolveOptions& options, const Observer& observer) {
  check_backend(problem, options);
  const EvaluationCache::Watch watch{observer, Clock::now()};
  const Eigen::VectorXd x = checked_start(problem);
  Attempt first = attempt_evaluation(problem, x, Request::values_and_gradients);
  if (!first.evaluation) return failed_start(problem, x, first.failure, options.backend, watch);

  EvaluationCache cache = make_cache(problem, {x, std::move(*first.evaluation)}, watch);
  return Run(cache, options).solve();
}

}  // namespace pleuel
