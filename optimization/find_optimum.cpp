#include "optimization/find_optimum.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/base/number_text.hpp"
#include "optimization/backends.hpp"
#include "optimization/broken_limits.hpp"
#include "optimization/designs_to_try.hpp"
#include "optimization/kkt_audit.hpp"
#include "optimization/objective_bend.hpp"
#include "optimization/recorded_problem.hpp"
#include "optimization/scaling.hpp"
#include "optimization/smooth_problem.hpp"

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
struct Way {
  std::string backend;
  double first_step = 1.0;
};

bool takes_equalities(const std::string& backend) {
  return make_optimizer(backend, {})->takes_equalities();
}

class Search {
 public:
  Search(SearchedProblem& searched, const SolveOptions& options, const Observer& observer,
         const Notice& notice)
      : searched_(searched),
        problem_(searched.problem()),
        options_(options),
        observer_(observer),
        notice_(notice),
        start_(start_of(problem_)) {
    const auto& limits = problem_.constraints();
    const bool has_equalities =
        std::any_of(limits.begin(), limits.end(), std::mem_fn(&Constraint::is_equality));
    for (const std::string& backend : options.other_backends) {
      if (!has_equalities || takes_equalities(backend)) ways_.push_back({backend});
    }
    ways_.push_back({options.backend, short_first_step});
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
      } else if (next_way_ < ways_.size() && !total_.gradients_are_disproved) {
        const Way& way = ways_[next_way_++];
        tell(fmt::format("not verified with {}: the search goes on with {}{}", total_.backend,
                         way.backend, way.first_step < 1.0 ? " and shorter steps" : ""));
        attempt(way, total_.x);
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
    return objective_bend(problem_, total_.x, total_.evaluation, evaluate) < much;
  }

  /// What is small is measured by the end of the search so far, where it begins anew. Where that
  /// finds nothing better, the proof stands.
  void begin_at_the_end() {
    const double before = total_.evaluation.objective;
    const std::string message = total_.message;
    reference_ = before;
    total_.status = Status::stalled;
    next_way_ = 0;
    tell(
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

  void tell(const std::string& sentence) const {
    if (notice_) notice_(sentence);
  }

  Observer following_observer() const {
    if (!observer_) return {};
    return [this](const EvaluationRecord& record) { observer_(following(record, total_)); };
  }

  void attempt(const Way& way, const Eigen::VectorXd& from) {
    SolveOptions options = options_;
    options.backend = way.backend;
    options.first_step = way.first_step;
    options.patience = options_.patience > 0 ? options_.patience : patience;
    options.max_iterations = std::max(1, options_.max_iterations - total_.iterations);
    options.earlier.iterations += total_.iterations;
    if (!total_.history.empty()) options.earlier.restarts += total_.restarts + 1;
    add(searched_.attempt(from, options, following_observer()), way.backend);
  }

  /// Joins the run with what was before it; the better design is the answer.
  void add(Result next, const std::string& method) {
    std::vector<SearchPart> parts = std::move(total_.parts);
    parts.push_back({method, next.status, next.evaluations});
    if (total_.history.empty()) {
      total_ = std::move(next);
    } else {
      const bool is_first = !has_design();
      Result before = std::move(total_);
      continue_from(before, next);
      ++next.restarts;
      total_ = is_first || is_better(next, before)
                   ? std::move(next)
                   : with_effort_of(std::move(next), std::move(before));
    }
    total_.parts = std::move(parts);
  }

  bool is_better(const Result& one, const Result& other) const {
    if (!one.evaluation.has_gradients()) return false;
    const auto rank = [&](const Result& result) {
      const bool is_within = result.max_violation <= options_.verdict.violation;
      return result.status == Status::verified ? 2 : is_within ? 1 : 0;
    };
    if (rank(one) != rank(other)) return rank(one) > rank(other);
    if (rank(one) == 0) return one.max_violation < other.max_violation;
    const double difference = one.evaluation.objective - other.evaluation.objective;
    return difference <= same_to_rounding * std::abs(other.evaluation.objective);
  }

  /// The start cannot be evaluated.
  void begin_elsewhere() {
    const auto [other, part] = recorded<std::optional<Eigen::VectorXd>>(
        [&](const LimitRows& rows) { return evaluable_design(*rows.problem); });
    total_.parts.push_back(part);
    if (!other) {
      total_.message +=
          fmt::format("; nor can {} other designs between the bounds", part.evaluations);
      return;
    }
    tell(fmt::format("the start cannot be evaluated: the search begins at {}",
                     describe_design(problem_, *other)));
    attempt({options_.backend}, *other);
    begun_elsewhere_ = true;
  }

  /// Does something with the rows of the limits, its evaluations as a part of the search.
  template <class Outcome>
  std::pair<Outcome, SearchPart> recorded(
      const std::function<Outcome(const LimitRows& rows)>& work) {
    const LimitRows rows = searched_.limit_rows();
    const Observer observer = following_observer();
    RecordedProblem problem(
        *rows.problem, [&](EvaluationRecord record) { return completed(rows, std::move(record)); },
        observer);
    Outcome outcome = work(LimitRows{&problem, rows.constraint_of_row});
    SearchPart part{"restoration", Status::stalled, int_size(problem.history())};
    Result effort;
    effort.history = problem.history();
    effort.evaluations = part.evaluations;
    effort.gradient_evaluations = effort.iterations = problem.gradient_evaluations();
    effort.seconds = problem.seconds();
    if (!effort.history.empty()) {
      continue_from(total_, effort);
      total_ = with_effort_of(std::move(effort), std::move(total_));
    }
    return std::pair(std::move(outcome), std::move(part));
  }

  EvaluationRecord completed(const LimitRows& rows, EvaluationRecord record) const {
    record.constraints = rows.fold(record.constraints, problem_.constraints());
    if (magnitudes_.size() > 0) {
      record.max_violation = max_violation(problem_, record.constraints, magnitudes_);
    }
    return record;
  }

  void find_magnitudes() {
    magnitudes_ =
        constraint_scales(problem_, total_.evaluation, variable_scales(problem_, total_.x));
  }

  /// A design within the limits.
  std::optional<Eigen::VectorXd> restored() {
    if (restorations_ == most_restorations) return std::nullopt;
    ++restorations_;
    find_magnitudes();
    tell("no design within the limits so far: the search goes on with the limits alone");
    const Eigen::VectorXd best = best_seen();
    auto [inside, part] = recorded<std::optional<Eigen::VectorXd>>([&](const LimitRows& rows) {
      return design_within_limits(rows, problem_, magnitudes_, best);
    });
    part.status = inside ? Status::verified : Status::infeasible;
    total_.parts.push_back(part);
    return inside;
  }

  Eigen::VectorXd best_seen() const {
    return best_record(total_.history, options_.verdict.violation).x;
  }

  /// Says what is in conflict, or goes on if after all nothing is.
  void explain() {
    tell("the limits seem to contradict each other: which, and by how much, is looked for");
    const Eigen::VectorXd best = best_seen();
    const int iterations = std::min(least_violation_iterations, options_.max_iterations);
    auto [least, part] = recorded<LeastViolation>([&](const LimitRows& rows) {
      return find_least_violation(rows, problem_.constraints(), best, iterations);
    });
    part.method = "least violation";
    part.status = least.is_proven ? Status::verified : Status::stalled;
    total_.parts.push_back(part);
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
    total_.x = x;
    total_.evaluation = std::move(*attempt.evaluation);
    total_.max_violation = max_violation(problem_, total_.evaluation.constraints, magnitudes_);
    const KktAudit audit = audit_kkt(problem_, {x, total_.evaluation, total_.max_violation},
                                     total_.evaluation, magnitudes_);
    total_.kkt_residual = audit.residual;
    total_.bound_multipliers = audit.bound_multipliers;
    total_.constraint_multipliers = Eigen::VectorXd::Zero(magnitudes_.size());
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

  SearchedProblem& searched_;
  Problem& problem_;
  const SolveOptions& options_;
  const Observer& observer_;
  const Notice& notice_;
  const Eigen::VectorXd start_;
  std::vector<Way> ways_;
  std::size_t next_way_ = 0;
  int restorations_ = 0;
  double reference_ = 0.0;  ///< objective that the last proof is measured by
  bool begun_elsewhere_ = false;
  Eigen::VectorXd magnitudes_;  ///< of the constraints; empty before the first restoration
  Result total_;
};

}  // namespace

Result find_optimum(SearchedProblem& searched, const SolveOptions& options,
                    const Observer& observer, const Notice& notice) {
  return Search(searched, options, observer, notice).run();
}

Result find_optimum(Problem& problem, const SolveOptions& options, const Observer& observer,
                    const Notice& notice) {
  SmoothProblem searched(problem);
  return find_optimum(searched, options, observer, notice);
}

}  // namespace pleuel
