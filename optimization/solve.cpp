#include "optimization/solve.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "optimization/backends.hpp"
#include "optimization/kkt_audit.hpp"
#include "optimization/scaling.hpp"

namespace pleuel {

namespace {

void check_backend(const Problem& problem, const SolveOptions& options) {
  const auto backend = make_optimizer(options.backend, {options.tolerance});
  for (const Constraint& constraint : problem.constraints()) {
    if (constraint.is_equality() && !backend->takes_equalities()) {
      throw InputError(fmt::format(
          "/constraints/{} is an equality, which {} does not know; use nlopt-slsqp or ipopt",
          constraint.name, options.backend));
    }
  }
}

Result failed_start(const Problem& problem, const Eigen::VectorXd& x, const std::string& failure,
                    const std::string& backend, const EvaluationCache::Watch& watch) {
  EvaluationRecord record = record_of(x, Request::values_and_gradients, {std::nullopt, failure});
  record.evaluation = 1;
  record.seconds = watch.time.seconds();
  show(watch.observer, record);

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

/// The backend that polishes. Its steps near an optimum are those of Newton's method on the KKT
/// conditions, with the Hessian that it learns.
constexpr const char* polisher = "nlopt-slsqp";

constexpr double near_optimum = 0.1;        ///< KKT residual
constexpr double near_limits = 1e-2;        ///< relative violation
constexpr double part_of_gain = 0.1;        ///< that is left of Tolerances::gain without a polish
constexpr double polish_tolerance = 1e-10;  ///< a small part changes the objective by little
constexpr double least_terms = 1e-6;        ///< of T_max: balanced up to here
constexpr int consecutive_failures = 3;
/// Evaluations without gradients: near an optimum a full step does, or noise is all there is.
constexpr int line_search = 10;

Eigen::VectorXd balance(const KktAudit& audit) {
  const double largest = audit.terms.maxCoeff();
  if (!(largest > 0.0)) return Eigen::VectorXd::Ones(audit.terms.size());
  return (audit.terms / largest).cwiseMax(least_terms).cwiseInverse().cwiseSqrt();
}

/// Whether a design is so near an optimum that a few steps are likely to prove or improve it:
/// limits nearly kept, KKT residual below 0.1, and either unproven, or proven with more than a
/// tenth of Tolerances::gain left.
bool is_worth_polishing(const Verdict& verdict, const Tolerances& tolerances) {
  if (verdict.status == Status::verified) {
    return verdict.gain_left > part_of_gain * tolerances.gain;
  }
  return !verdict.gradients_are_disproved && !verdict.better_neighbour &&
         verdict.design.max_violation <= near_limits && verdict.audit.residual <= near_optimum;
}

/// Goes on from a design with the polisher and a tight tolerance, in variables that are balanced:
/// with the terms T of the audit, each s_i is multiplied with √(T_max / T_i), since a part of the
/// objective has a curvature of about its terms. A Hessian near 1 is what the polisher begins with;
/// small parts would come after many steps only.
/// @returns the design where it ends, within its bounds
Eigen::VectorXd polish(EvaluationCache& cache, const EvaluatedDesign& from, const KktAudit& audit,
                       const ScaledProblem::Budget& budget) {
  return run_backend(cache, from, polisher, polish_tolerance, budget, balance(audit)).x;
}

/// One optimization from a start that could be evaluated.
class Run {
 public:
  Run(EvaluationCache& cache, const EvaluatedDesign& start, const SolveOptions& options)
      : cache_(cache),
        options_(options),
        start_(start),
        reference_(reference()),
        begun_at_(start.x) {}

  Result solve() {
    double tolerance = options_.tolerance;
    if (options_.takes_verified_start) {
      cache_.set_purpose(Purpose::audit);
      const Verdict at_start = judged(start_);
      if (at_start.status == Status::verified) return make_result(at_start);
    }
    Verdict verdict = polished(improve(start_, tolerance));
    while (may_restart(verdict)) {
      const EvaluatedDesign from = start_of_restart(verdict);
      restart_size_ = from.x == begun_at_ ? size_of_other_steps * restart_size_ : 1.0;
      begun_at_ = from.x;
      tolerance *= tolerance_factor;
      Verdict next = polished(improve(from, tolerance));
      unchanged_restarts_ = next.design.x == verdict.design.x ? unchanged_restarts_ + 1 : 0;
      verdict = std::move(next);
    }
    return make_result(std::move(verdict));
  }

  Result search() {
    search_from(start_, options_.tolerance);
    Result result;
    result.status = is_lost_ ? Status::failed : Status::stalled;
    result.message = backend_reason_;
    const EvaluationRecord& best = best_record(cache_.history(), options_.verdict.violation);
    result.x = best.x;
    result.evaluation.objective = best.objective;
    result.evaluation.constraints = best.constraints;
    result.max_violation = best.max_violation;
    add_counts(result);
    return result;
  }

 private:
  static constexpr double tolerance_factor = 0.1;
  /// Of the variables, where a restart would otherwise go the way of the one before, digit for
  /// digit: first steps are a tenth as long (they go with the square).
  static constexpr double size_of_other_steps = 0.3;
  static constexpr int evaluations_per_iteration = 5;
  /// Evaluations without gradients after which a backend is better started anew.
  static constexpr int longest_line_search = 30;
  /// Violation up to which a design is preferred: tighter than what a verdict allows, so that no
  /// tolerance is exploited.
  static constexpr double strict_violation = 1e-6;
  /// Of the objective: slopes of a start that is nearly an optimum.
  static constexpr double nearly_level = 0.1;
  /// Of its slopes: an objective that nearly vanishes.
  static constexpr double nearly_nothing = 0.01;

  /// The start, which says what is small of the objective and its slopes. At a start that is nearly an
  /// optimum these say nothing, but how the slopes change does.
  Evaluation reference() {
    Evaluation reference = start_.evaluation;
    const Eigen::VectorXd s = variable_scales(cache_.problem(), start_.x);
    const double value = std::abs(reference.objective);
    const double slope =
        scaled_objective_gradient(cache_.problem(), reference, s).lpNorm<Eigen::Infinity>();
    if (slope >= nearly_level * value && value >= nearly_nothing * slope) return reference;
    cache_.set_purpose(Purpose::audit);
    const double curvature =
        objective_curvature(cache_.problem(), start_.x, reference, [&](const Eigen::VectorXd& x) {
          return cache_.evaluate(x, Request::values_and_gradients);
        });
    reference.objective += std::copysign(curvature, reference.objective);
    return reference;
  }

  /// A better design beside this one, or this one itself.
  EvaluatedDesign start_of_restart(const Verdict& verdict) {
    if (verdict.better_neighbour) {
      ++escapes_;
      std::optional<EvaluatedDesign> neighbour = known(*verdict.better_neighbour);
      if (neighbour) return std::move(*neighbour);
    }
    ++restarts_;
    return verdict.design;
  }

  /// Where the backend comes to from this design, or the best design seen so far if that is better:
  /// a backend may stop slightly outside the limits, or leave a good point.
  Verdict improve(const EvaluatedDesign& from, double tolerance) {
    const Eigen::VectorXd end = search_from(from, tolerance);
    const History steps = search_steps();
    return best_of({end, best_record(steps, strict_violation).x,
                    best_record(steps, options_.verdict.violation).x},
                   from);
  }

  /// Without what a polish saw on its way: its steps may use up all that limits tolerate.
  History search_steps() const {
    History steps = cache_.history();
    std::erase_if(steps,
                  [](const EvaluationRecord& record) { return record.purpose != Purpose::search; });
    return steps;
  }

  /// The best one of some designs and of that where they come from, judged. The first one that is
  /// proven, strictly within the limits, is it.
  Verdict best_of(const std::vector<Eigen::VectorXd>& designs, const EvaluatedDesign& from) {
    cache_.set_purpose(Purpose::audit);
    Verdict verdict = judged(from);
    for (const Eigen::VectorXd& x : designs) {
      std::optional<Verdict> candidate = audit(x);
      if (candidate && is_better(*candidate, verdict)) verdict = std::move(*candidate);
      const bool strict = verdict.design.max_violation <= strict_violation;
      if (verdict.status == Status::verified && strict) break;
    }
    return verdict;
  }

  /// What the polisher makes of an answer that is nearly an optimum; else the answer itself.
  Verdict polished(Verdict verdict) {
    if (!is_worth_polishing(verdict, options_.verdict) || is_lost_ ||
        polishes_ >= options_.max_polishes || cache_.iterations() >= polish_budget().iterations) {
      return verdict;
    }
    ++polishes_;
    cache_.set_purpose(Purpose::polish);
    const std::size_t first = cache_.history().size();
    const Eigen::VectorXd end = polish(cache_, verdict.design, verdict.audit, polish_budget());
    const Eigen::VectorXd last = last_step(first, end);
    cache_.set_purpose(Purpose::audit);
    for (const Eigen::VectorXd& x : {last, end}) {
      if (x == verdict.design.x) continue;
      std::optional<Verdict> next = audit(x);
      if (!next || !is_refined(*next, verdict)) continue;
      is_polished_ = true;
      verdict = std::move(*next);
      if (verdict.status == Status::verified) break;
    }
    return verdict;
  }

  /// Where the steps of a polish led: the last design with gradients from this evaluation on. Its
  /// answer may be another one: the lowest objective within the backend's own tolerance of the
  /// limits, be it the design that it began with.
  Eigen::VectorXd last_step(std::size_t first, const Eigen::VectorXd& end) const {
    const History& history = cache_.history();
    for (std::size_t i = history.size(); i > first; --i) {
      const EvaluationRecord& record = history[i - 1];
      if (record.request == Request::values_and_gradients && !record.has_failed()) return record.x;
    }
    return end;
  }

  /// Only a proof counts, or a lower objective strictly within the limits.
  bool is_refined(const Verdict& next, const Verdict& verdict) const {
    const bool is_proof = next.status == Status::verified && verdict.status != Status::verified;
    const bool keeps_limits = next.design.max_violation <= strict_violation;
    return is_proof || (keeps_limits && is_better(next, verdict));
  }

  Eigen::VectorXd search_from(const EvaluatedDesign& from, double tolerance) {
    cache_.set_purpose(Purpose::search);
    const double size = std::sqrt(options_.first_step) * restart_size_;
    BackendEnd end =
        run_backend(cache_, from, options_.backend, tolerance,
                    {options_.max_iterations, max_evaluations(), options_.max_consecutive_failures,
                     longest_line_search, options_.patience},
                    Eigen::VectorXd::Constant(from.x.size(), size));
    is_lost_ = end.has_left_numbers || has_failed_too_often();
    backend_reason_ = std::move(end.reason);
    return std::move(end.x);
  }

  /// nullopt if the design, or its gradients, cannot be evaluated.
  std::optional<Verdict> audit(const Eigen::VectorXd& x) {
    if (const Verdict* verdict = verdict_at(x)) return *verdict;
    const std::optional<EvaluatedDesign> design = known(x);
    if (!design) return std::nullopt;
    return judged(*design);
  }

  /// nullopt if the design, or its gradients, cannot be evaluated.
  std::optional<EvaluatedDesign> known(const Eigen::VectorXd& x) {
    const Evaluation* evaluation = cache_.evaluate(x, Request::values_and_gradients);
    if (evaluation == nullptr) return std::nullopt;
    return EvaluatedDesign{
        x, *evaluation,
        max_violation(cache_.problem(), evaluation->constraints, cache_.scales().constraints)};
  }

  /// Judges a design once.
  Verdict judged(const EvaluatedDesign& design) {
    if (const Verdict* verdict = verdict_at(design.x)) return *verdict;
    verdicts_.push_back(judge(cache_, design, reference_, options_.verdict));
    return verdicts_.back();
  }

  const Verdict* verdict_at(const Eigen::VectorXd& x) const {
    const auto found = std::ranges::find_if(
        verdicts_, [&](const Verdict& verdict) { return verdict.design.x == x; });
    return found == verdicts_.end() ? nullptr : &*found;
  }

  /// Proven before unproven, within the limits before outside; then the lower objective, or the
  /// smaller violation. Of two unproven designs of which one uses the tolerance of the limits, the
  /// one that fulfils the KKT conditions better: what a violation gains is no merit.
  bool is_better(const Verdict& one, const Verdict& other) const {
    const auto is_strict = [](const Verdict& verdict) {
      return verdict.design.max_violation <= strict_violation;
    };
    const auto rank = [&](const Verdict& verdict) {
      const bool verified = verdict.status == Status::verified;
      const bool within = verdict.design.max_violation <= options_.verdict.violation;
      return verified && is_strict(verdict) ? 3 : verified ? 2 : within ? 1 : 0;
    };
    if (rank(one) != rank(other)) return rank(one) > rank(other);
    if (rank(one) == 0) return one.design.max_violation < other.design.max_violation;
    if (is_strict(one) != is_strict(other)) return one.audit.residual < other.audit.residual;
    return one.design.evaluation.objective < other.design.evaluation.objective;
  }

  int max_evaluations() const { return evaluations_per_iteration * options_.max_iterations; }

  ScaledProblem::Budget polish_budget() const {
    const int iterations = options_.max_iterations + options_.polish_iterations;
    return {iterations, evaluations_per_iteration * iterations, consecutive_failures, line_search};
  }

  bool has_failed_too_often() const {
    return cache_.consecutive_failures() >= options_.max_consecutive_failures;
  }

  bool is_exhausted() const {
    return cache_.iterations() >= options_.max_iterations ||
           cache_.evaluations() >= max_evaluations();
  }

  bool may_restart(const Verdict& verdict) const {
    const bool is_settled = verdict.status == Status::verified || verdict.gradients_are_disproved;
    if (is_settled || is_exhausted() || is_lost_) return false;
    // Where find_optimum() searches, it knows better ways into the limits.
    const bool leaves_it = options_.patience > 0 && restarts_ > 0;
    if (verdict.status == Status::infeasible && leaves_it) return false;
    if (verdict.better_neighbour) return escapes_ < options_.max_escapes;
    return unchanged_restarts_ < 2 && restarts_ < options_.max_restarts;
  }

  Result make_result(Verdict verdict) const {
    Result result;
    result.status = verdict.status;
    result.message = verdict.message;
    if (verdict.status != Status::verified) add_reason(result);
    if (is_polished_) result.polished_with = polisher;
    if (is_polished_) result.message += fmt::format("; polished with {}", polisher);
    if (verdict.status == Status::verified && options_.starts == 1) {
      result.message += "; from one start: other local optima were not looked for";
    }
    result.gradients_are_disproved = verdict.gradients_are_disproved;
    set_answer(result, cache_.problem(), std::move(verdict.design), verdict.audit,
               cache_.scales().constraints);
    add_counts(result);
    return result;
  }

  void add_counts(Result& result) const {
    result.backend = options_.backend;
    result.evaluations = cache_.evaluations();
    result.gradient_evaluations = cache_.gradient_evaluations();
    result.iterations = cache_.iterations();
    result.restarts = restarts_ + escapes_;
    result.seconds = cache_.seconds();
    result.history = cache_.history();
  }

  /// Why the search for an optimum ended where it did.
  void add_reason(Result& result) const {
    if (is_lost_) result.status = Status::failed;
    if (is_exhausted()) {
      const int iterations = options_.max_iterations + options_.earlier.iterations;
      result.message += fmt::format("; the budget of {} iterations ({} evaluations) is used up",
                                    iterations, evaluations_per_iteration * iterations);
    } else {
      const int restarts = restarts_ + escapes_ + options_.earlier.restarts;
      result.message += fmt::format("; {} said after {} restart{}: {}", options_.backend, restarts,
                                    restarts == 1 ? "" : "s", backend_reason_);
    }
    result.message += describe_failures();
  }

  std::string describe_failures() const {
    const History& history = cache_.history();
    const auto last =
        std::find_if(history.rbegin(), history.rend(), std::mem_fn(&EvaluationRecord::has_failed));
    if (last == history.rend()) return "";
    return fmt::format("; {} of {} evaluations failed{}, the last with: {} (at {})",
                       count_failures(history), history.size(),
                       has_failed_too_often() ? " and too many in a row" : "", last->failure,
                       describe_design(cache_.problem(), last->x));
  }

  EvaluationCache& cache_;
  const SolveOptions& options_;
  const EvaluatedDesign start_;
  const Evaluation reference_;
  std::vector<Verdict> verdicts_;  ///< of all designs that were judged
  int restarts_ = 0;
  int escapes_ = 0;
  int unchanged_restarts_ = 0;
  Eigen::VectorXd begun_at_;  ///< the last run of the backend
  double restart_size_ = 1.0;
  int polishes_ = 0;
  bool is_polished_ = false;
  bool is_lost_ = false;
  std::string backend_reason_;
};

/// What is done with a start that can be evaluated.
Result run(Problem& problem, const SolveOptions& options, const Observer& observer,
           Result (Run::*work)()) {
  check_backend(problem, options);
  const EvaluationCache::Watch watch{observer};
  const Eigen::VectorXd x = checked_start(problem);
  Attempt first = attempt_evaluation(problem, x, Request::values_and_gradients);
  if (!first.evaluation) return failed_start(problem, x, first.failure, options.backend, watch);

  EvaluatedDesign start{x, std::move(*first.evaluation)};
  const Eigen::VectorXd variables = variable_scales(problem, start.x);
  EvaluationCache cache(
      problem, start, {variables, constraint_scales(problem, start.evaluation, variables)}, watch);
  start.max_violation = cache.history().front().max_violation;
  Run one(cache, start, options);
  return (one.*work)();
}

}  // namespace

Result solve(Problem& problem, const SolveOptions& options, const Observer& observer) {
  return run(problem, options, observer, &Run::solve);
}

Result search(Problem& problem, const SolveOptions& options, const Observer& observer) {
  return run(problem, options, observer, &Run::search);
}

}  // namespace pleuel
