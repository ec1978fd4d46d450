#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/stopwatch.hpp"
#include "optimization/backends.hpp"
#include "optimization/kkt_audit.hpp"
#include "optimization/scaling.hpp"
#include "optimization/solve.hpp"

namespace pleuel {

namespace {

/// Iterations without a better design after which a backend is stopped.
constexpr int patience = 25;
/// Relative size of the first steps of a backend that begins with shorter ones.
constexpr double short_first_step = 0.1;
/// Relative difference of objectives that is none: the later attempt then counts.
constexpr double same_to_rounding = 1e-9;
/// How often the objective at the end may become the measure of the next proof.
constexpr int most_references = 8;
/// Part of the objective at the start that counts as much as that of a design (scaling.hpp).
constexpr double part_of_reference = 1e-3;
/// How often the limits are restored before they are taken for contradictory.
constexpr int most_restorations = 2;
/// Iterations of each optimization that looks for the least violation.
constexpr int least_violation_iterations = 60;

/// A backend, and the size of its first steps.
struct BackendSetup {
  std::string backend;
  double first_step = 1.0;
};

class Search {
 public:
  Search(const SearchedProblem& searched, const SolveOptions& options, const Observer& observer,
         const Notice& notice)
      : searched_(searched),
        problem_(searched.problem),
        options_(options),
        observer_(observer),
        notice_(notice),
        start_(start_of(problem_)) {
    const bool has_equalities =
        std::ranges::any_of(problem_.constraints(), &Constraint::is_equality);
    for (const std::string& backend : options.other_backends) {
      if (!has_equalities || make_optimizer(backend, {})->takes_equalities()) {
        others_.push_back({backend});
      }
    }
    others_.push_back({options.backend, short_first_step});
  }

  Result run() {
    attempt({options_.backend}, start_);
    if (!has_design()) begin_elsewhere();
    search_on();
    if (has_design()) reference_ = first_design(total_.history).objective;
    for (int i = 0; i < most_references && is_measured_by_far_too_much(); ++i) begin_at_the_end();
    tell_of_parts();
    return std::move(total_);
  }

 private:
  void search_on() {
    while (has_design() && !is_settled()) {
      if (is_outside()) {
        const std::optional<Eigen::VectorXd> inside = restored();
        if (!inside) {
          explain();
          break;
        }
        attempt({options_.backend}, *inside);
      } else if (next_other_ < others_.size() && !total_.gradients_are_disproved) {
        const BackendSetup& next = others_[next_other_++];
        notify(notice_,
               fmt::format("not verified with {}: the search goes on with {}{}", total_.backend,
                           next.backend, next.first_step < 1.0 ? " and shorter steps" : ""));
        attempt(next, total_.x);
      } else {
        break;
      }
    }
  }

  /// Whether a proof means nothing, since all that is left is small beside the objective where the
  /// search began: damage by fatigue, or a penalty, may be many decades larger there.
  bool is_measured_by_far_too_much() {
    if (!is_verified() || total_.evaluation.objective == 0.0) return false;
    const double much = part_of_reference * std::abs(reference_);
    const Eigen::VectorXd s = variable_scales(problem_, total_.x);
    if (objective_scale(problem_, total_.evaluation, s) >= much) return false;
    Attempt beside;
    const auto evaluate = [&](const Eigen::VectorXd& x) {
      beside = attempt_evaluation(problem_, x, Request::values_and_gradients);
      return beside.evaluation ? &*beside.evaluation : nullptr;
    };
    return objective_curvature(problem_, total_.x, total_.evaluation, evaluate) < much;
  }

  /// What is small is measured by the end of the search so far, where it begins anew. Where that
  /// finds nothing better, the proof stands.
  void begin_at_the_end() {
    const double before = total_.evaluation.objective;
    const std::string message = total_.message;
    reference_ = before;
    total_.status = Status::stalled;
    next_other_ = 0;
    notify(
        notice_,
        "what is small was measured by the start, where the objective is many times as large: the "
        "search begins anew at its end");
    attempt({options_.backend}, total_.x);
    search_on();
    const double after = total_.evaluation.objective;
    if (is_verified() || before - after > options_.verdict.gain * std::abs(after)) return;
    total_.status = Status::verified;
    total_.message = message;
  }

  bool has_design() const { return total_.evaluation.has_gradients(); }

  bool is_verified() const { return total_.status == Status::verified; }

  bool is_outside() const { return total_.max_violation > options_.verdict.violation; }

  bool is_settled() const {
    if (is_verified()) return true;
    return !is_outside() && total_.iterations >= options_.max_iterations;
  }

  /// Joins the run with what was before it; the better design is the answer.
  void attempt(const BackendSetup& setup, const Eigen::VectorXd& from) {
    SolveOptions options = options_;
    options.backend = setup.backend;
    options.first_step = setup.first_step;
    options.patience = options_.patience > 0 ? options_.patience : patience;
    options.max_iterations = std::max(1, options_.max_iterations - total_.iterations);
    options.earlier.iterations += total_.iterations;
    const bool is_first = total_.history.empty();
    if (!is_first) options.earlier.restarts += total_.restarts + 1;
    Result next = run_after(total_, observer_, [&](const Observer& observer) {
      return searched_.attempt(from, options, observer);
    });
    std::vector<SearchPart> parts = std::move(total_.parts);
    parts.push_back({setup.backend, next.status, next.evaluations - total_.evaluations});
    if (!is_first) ++next.restarts;
    const bool is_answer =
        !has_design() || is_better(next, total_, options_.verdict.violation, same_to_rounding);
    total_ = is_answer ? std::move(next) : with_effort_of(std::move(next), std::move(total_));
    total_.parts = std::move(parts);
  }

  /// Does something with the rows of the limits, its evaluations as a part of the search.
  template <class Work>
  auto with_limit_rows(const std::string& method, const Work& work) {
    LimitRows rows = searched_.limit_rows();
    const Stopwatch watch;
    const double seconds_before = total_.seconds;
    FunctionProblem recorded(*rows.problem, [&](const Eigen::VectorXd& x, Request request) {
      Attempt attempt = attempt_evaluation(*rows.problem, x, request);
      total_.seconds = seconds_before + watch.seconds();
      record(rows.constraint_of_row, record_of(x, request, attempt));
      if (!attempt.evaluation) throw EvaluationFailure(attempt.failure);
      return std::move(*attempt.evaluation);
    });
    const int evaluations = total_.evaluations;
    auto outcome = work(LimitRows{&recorded, rows.constraint_of_row});
    total_.parts.push_back({method, Status::stalled, total_.evaluations - evaluations});
    return outcome;
  }

  /// An evaluation of rows, whoever asked for it, as one of a restoration.
  void record(const ConstraintOfRow& constraint_of_row, EvaluationRecord record) {
    const int gradients = record.request == Request::values_and_gradients ? 1 : 0;
    total_.gradient_evaluations += gradients;
    record.purpose = Purpose::restoration;
    record.evaluation = ++total_.evaluations;
    record.iteration = total_.iterations += gradients;
    record.seconds = total_.seconds;
    if (!record.has_failed()) {
      record.constraints =
          worst_values(constraint_of_row, record.constraints, problem_.constraints());
      if (magnitudes_.size() > 0) {
        record.max_violation = max_violation(problem_, record.constraints, magnitudes_);
      }
    }
    total_.history.push_back(std::move(record));
    show(observer_, total_.history.back());
  }

  /// The start cannot be evaluated.
  void begin_elsewhere() {
    const auto other = with_limit_rows(
        "restoration", [](const LimitRows& rows) { return evaluable_design(*rows.problem); });
    if (!other) {
      total_.message += fmt::format("; nor can {} other designs between the bounds",
                                    total_.parts.back().evaluations);
      return;
    }
    notify(notice_, fmt::format("the start cannot be evaluated: the search begins at {}",
                                describe_design(problem_, *other)));
    attempt({options_.backend}, *other);
    begun_elsewhere_ = true;
  }

  /// A design within the limits.
  std::optional<Eigen::VectorXd> restored() {
    if (restorations_ == most_restorations) return std::nullopt;
    ++restorations_;
    magnitudes_ =
        constraint_scales(problem_, total_.evaluation, variable_scales(problem_, total_.x));
    notify(notice_, "no design within the limits so far: the search goes on with the limits alone");
    const Eigen::VectorXd best = best_seen();
    const auto inside = with_limit_rows("restoration", [&](const LimitRows& rows) {
      return design_within_limits(rows, problem_, magnitudes_, best);
    });
    total_.parts.back().status = inside ? Status::verified : Status::infeasible;
    return inside;
  }

  Eigen::VectorXd best_seen() const {
    return best_record(total_.history, options_.verdict.violation).x;
  }

  /// Says what is in conflict, or goes on if after all nothing is.
  void explain() {
    notify(notice_,
           "the limits seem to contradict each other: which, and by how much, is looked for");
    const Eigen::VectorXd best = best_seen();
    const int iterations = std::min(least_violation_iterations, options_.max_iterations);
    LeastViolation least = with_limit_rows("least violation", [&](const LimitRows& rows) {
      return find_least_violation(rows, problem_.constraints(), best, iterations);
    });
    total_.parts.back().status = least.is_proven ? Status::verified : Status::stalled;
    if (!(least.violation > options_.verdict.violation)) {
      attempt({options_.backend}, least.x);
      if (!is_outside()) return;
    }
    settle_at(best_seen());
    // Where one that was seen before breaks them less, it was no least violation.
    const bool is_least = total_.max_violation >= (1.0 - 1e-3) * least.violation;
    conclude(is_least ? std::move(least) : LeastViolation{});
  }

  void conclude(LeastViolation least) {
    std::string conflict = describe(least, problem_);
    if (least.is_proven && !conflict.empty()) {
      total_.status = Status::infeasible;
      total_.message =
          fmt::format("no design keeps all limits, as far as local searches see: {}", conflict);
    } else {
      if (conflict.empty()) {
        conflict = broken_limits(problem_, total_.evaluation.constraints, magnitudes_,
                                 options_.verdict.violation);
      }
      total_.status = Status::stalled;
      total_.message = fmt::format(
          "no design that keeps all limits was found, which does not prove that there is none. Of "
          "those seen, this one breaks them least ({:.2g} relative): {}",
          total_.max_violation, conflict);
    }
    if (!least.limits.empty()) total_.least_violation = std::move(least);
  }

  /// Makes this design the answer, of which nothing is proven.
  void settle_at(const Eigen::VectorXd& x) {
    if (x == total_.x) return;
    Attempt attempt = attempt_evaluation(problem_, x, Request::values_and_gradients);
    if (!attempt.evaluation) return;
    const double violation = max_violation(problem_, attempt.evaluation->constraints, magnitudes_);
    set_unproven_answer(total_, problem_, {x, std::move(*attempt.evaluation), violation},
                        magnitudes_);
    total_.constraint_multipliers.setZero();
  }

  /// What led to the answer, if that was more than one run of one backend.
  void tell_of_parts() {
    if (begun_elsewhere_) {
      total_.message += "; the start cannot be evaluated, the search began at " +
                        describe_design(problem_, first_design(total_.history).x);
    }
    if (total_.parts.size() < 2 || !is_verified()) return;
    std::vector<std::string> before;
    for (std::size_t i = 0; i + 1 < total_.parts.size(); ++i) {
      before.push_back(total_.parts[i].method);
    }
    total_.message +=
        fmt::format("; found with {} after {}", total_.backend, fmt::join(before, ", "));
  }

  const SearchedProblem& searched_;
  Problem& problem_;
  const SolveOptions& options_;
  const Observer& observer_;
  const Notice& notice_;
  const Eigen::VectorXd start_;
  std::vector<BackendSetup> others_;  ///< that the search goes on with
  std::size_t next_other_ = 0;
  int restorations_ = 0;
  double reference_ = 0.0;  ///< objective that the last proof is measured by
  bool begun_elsewhere_ = false;
  Eigen::VectorXd magnitudes_;  ///< of the constraints; empty before the first restoration
  Result total_;
};

}  // namespace

Result find_optimum(const SearchedProblem& searched, const SolveOptions& options,
                    const Observer& observer, const Notice& notice) {
  return Search(searched, options, observer, notice).run();
}

Result find_optimum(Problem& problem, const SolveOptions& options, const Observer& observer,
                    const Notice& notice) {
  const auto attempt = [&](const Eigen::VectorXd& start, const SolveOptions& with,
                           const Observer& hears) {
    FunctionProblem started(problem, [&](const Eigen::VectorXd& x, Request request) {
      return problem.evaluate(x, request);
    });
    started.start_from(start);
    return solve(started, with, hears);
  };
  const auto limit_rows = [&] { return LimitRows{&problem, own_constraints(problem)}; };
  return find_optimum({problem, attempt, limit_rows}, options, observer, notice);
}

}  // namespace pleuel
