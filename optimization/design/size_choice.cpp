#include "optimization/design/size_choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/base/number_text.hpp"
#include "core/base/stopwatch.hpp"
#include "optimization/design/size_lists.hpp"
#include "optimization/linear_choice.hpp"
#include "optimization/result.hpp"
#include "optimization/scaling.hpp"

namespace pleuel {

namespace {

/// Choices that are all tried where each costs an optimization.
constexpr double most_optimized = 16.0;
/// That a linear model proposes at a time.
constexpr std::size_t proposals = 8, optimized_proposals = 3;
constexpr int most_rounds_of_choice = 25;
/// Batches of proposals of one model.
constexpr int most_batches = 6;
/// Sizes up and down that a linear model looks at.
constexpr int reach = 2;

/// Keeps the limits and is lighter, or breaks them less.
bool is_better(const SizeTrial& one, const SizeTrial& other) {
  if (one.keeps_limits() != other.keeps_limits()) return one.keeps_limits();
  return one.keeps_limits() ? one.objective < other.objective
                            : one.max_violation < other.max_violation;
}

/// Where slopes vanish, as at an optimum between the sizes, the nearer size is the better guess.
double distance_cost(double gap, double change, double objective) {
  return gap == 0.0 ? 0.0 : 1e-3 * std::abs(objective) * (change / gap) * (change / gap);
}

class SizeSearch {
 public:
  SizeSearch(StagedSolution& solution, const SearchSetup& setup)
      : solution_(solution),
        file_(solution.problem->file()),
        setup_(setup),
        lists_(file_.variables),
        is_optimized_(needs_optimization(file_)) {
    setup_.options.starts = 1;
    const Result& relaxed = solution.result;
    report_.relaxed_status = relaxed.status;
    report_.relaxed_objective = relaxed.evaluation.objective;
    report_.relaxed_x = relaxed.x;
    report_.combinations = lists_.combinations();
  }

  SizeChoiceReport run() {
    if (!solution_.result.evaluation.has_gradients()) return report_;  // the start failed
    const DesignProblem& problem = *solution_.problem;
    scales_ = constraint_scales(problem, solution_.result.evaluation,
                                variable_scales(problem, solution_.result.x));
    const double most = is_optimized_ ? most_optimized : most_simulated_choices;
    report_.is_exhaustive = report_.combinations <= most;
    notify(setup_.notice, fmt::format("the optimum between the sizes has {} = {} ({})",
                                      problem.file().objective->response,
                                      objective_text(report_.relaxed_objective),
                                      to_string(report_.relaxed_status)));
    if (report_.is_exhaustive) {
      notify(setup_.notice, fmt::format("all {} choices are tried", report_.combinations));
      attempt(lists_.all(), report_.relaxed_x);
    } else {
      search();
    }
    if (best_) conclude();
    return report_;
  }

 private:
  // ---- trials

  /// Tries those that were not tried yet, the others beginning at the given design.
  void attempt(const std::vector<Sizes>& choices, const Eigen::VectorXd& from) {
    std::vector<Sizes> news;
    std::set<Sizes> seen;
    for (const Sizes& choice : choices) {
      if (!tried_.contains(choice) && seen.insert(choice).second) news.push_back(choice);
    }
    if (news.empty()) return;
    std::vector<Eigen::VectorXd> designs;
    for (const Sizes& choice : news) designs.push_back(lists_.design(choice, from));
    std::vector<SizeTrial> answers =
        try_sizes(file_, designs, scales_, setup_.options, setup_.execution);
    const int at_once = std::min(setup_.execution.tasks.jobs, int_size(news));
    for (std::size_t i = 0; i < news.size(); ++i) keep(news[i], std::move(answers[i]), at_once);
  }

  /// @param at_once  so many trials run at the same time
  void keep(const Sizes& choice, SizeTrial trial, int at_once) {
    for (EvaluationRecord& record : trial.history) {
      record.purpose = Purpose::trial;
      record.iteration = 1;
    }
    add_effort(std::exchange(trial.history, {}), trial.seconds / at_once);
    ++report_.tried;
    if (trial.keeps_limits()) ++report_.feasible;
    const SizeTrial& kept = tried_.emplace(choice, std::move(trial)).first->second;
    if (!kept.has_failed() && (!best_ || is_better(kept, tried_.at(*best_)))) best_ = choice;
  }

  /// The effort of the whole run, in the relaxed result.
  void add_effort(History history, double seconds) {
    Result& all = solution_.result;
    for (EvaluationRecord& record : history) {
      record = following(std::move(record), all);
      show(setup_.observer, record);
    }
    for (const EvaluationRecord& record : history) {
      ++all.evaluations;
      if (record.request == Request::values_and_gradients) ++all.gradient_evaluations;
      all.iterations = std::max(all.iterations, record.iteration);
    }
    all.seconds += seconds;
    all.history.insert(all.history.end(), history.begin(), history.end());
  }

  // ---- search

  void search() {
    const Eigen::VectorXd& relaxed = report_.relaxed_x;
    propose(relaxed, solution_.result, lists_.below(relaxed), 0, 1);
    if (!best_) attempt({lists_.below(relaxed), lists_.nearest(relaxed)}, relaxed);
    for (int round = 0; best_ && round < most_rounds_of_choice; ++round) {
      const Sizes from = *best_;
      const Eigen::VectorXd x = tried_.at(from).x;
      const auto around = linearized(from);
      for (int batch = 0; around && batch < most_batches && *best_ == from; ++batch) {
        const int before = report_.tried;
        propose(x, *around, from, -reach, reach);
        if (report_.tried == before) break;
      }
      if (*best_ == from) attempt(lists_.exchanges(from, 1), x);
      if (*best_ == from) try_whole_lists(from, x);
      if (*best_ == from) {
        is_settled_ = true;
        return;
      }
      notify(setup_.notice,
             fmt::format("after {} choices: {} = {}{}", report_.tried, file_.objective->response,
                         objective_text(tried_.at(*best_).objective),
                         tried_.at(*best_).keeps_limits() ? "" : ", outside the limits"));
    }
  }

  /// Lists whose sections differ in more than size, as tubes with several walls do, go up and down in
  /// stiffness on the way: the better one may be far away.
  void try_whole_lists(const Sizes& from, const Eigen::VectorXd& x) {
    const std::vector<Sizes> exchanges = lists_.exchanges(from, std::numeric_limits<int>::max());
    const double most = is_optimized_ ? most_optimized : most_simulated_choices;
    if (static_cast<double>(exchanges.size()) > most) return;
    attempt(exchanges, x);
    report_.are_lists_tried = true;
  }

  /// Values and gradients at the best choice; multipliers where other variables were optimized.
  std::optional<Result> linearized(const Sizes& from) {
    const Eigen::VectorXd& x = tried_.at(from).x;
    const auto problem = setup_.problem_at(file_, x);
    keep_methods(*problem);
    const double violation = tried_.at(from).max_violation;
    const Stopwatch stopwatch;
    Attempt attempt = attempt_evaluation(*problem, x, Request::values_and_gradients);
    EvaluationRecord record = record_of(x, Request::values_and_gradients, attempt);
    record.evaluation = record.iteration = 1;
    record.purpose = Purpose::audit;
    if (attempt.evaluation) record.max_violation = violation;
    const double seconds = record.seconds = stopwatch.seconds();
    add_effort({simulated_with(file_, std::move(record))}, seconds);
    if (!attempt.evaluation) return std::nullopt;
    Result result;
    result.x = x;
    result.evaluation = std::move(*attempt.evaluation);
    if (is_optimized_) {
      const DesignProblem others(with_sizes(file_, x));
      result.constraint_multipliers =
          audit_kkt(others, {x, result.evaluation, violation}, result.evaluation, scales_)
              .constraint_multipliers;
    }
    return result;
  }

  /// Tries what a linear model at x thinks best: sizes from so many below to so many above those given.
  void propose(const Eigen::VectorXd& x, const Result& at, const Sizes& around, int down, int up) {
    const LinearChoiceModel model = linear_model(x, at, around, down, up);
    const std::size_t most = is_optimized_ ? optimized_proposals : proposals;
    std::vector<Sizes> choices;
    std::set<Sizes> known;
    for (const double allowed : {0.0, 0.01, 0.05, 0.2, 1.0, 1e6}) {
      for (PredictedChoice& one : best_choices(model, (most_batches + 2) * most, allowed)) {
        if (choices.size() == most) break;
        if (tried_.contains(one.sizes) || !known.insert(one.sizes).second) continue;
        if (!is_promising(one)) continue;
        choices.push_back(std::move(one.sizes));
      }
      // What is predicted to break limits is tried only while nothing keeps them, or hardly does.
      const bool has_some = choices.size() >= most / 2;
      if (choices.size() == most || (allowed >= 0.05 && has_some)) break;
      if (allowed >= 0.05 && best_ && tried_.at(*best_).keeps_limits()) break;
    }
    attempt(choices, x);
  }

  /// The objective and the limits at choices of sizes around a design, from their gradients there.
  /// Where other variables follow, limits do not count: what keeping them costs is in the slopes,
  /// df = (∇f + Jᵀμ) · dx.
  /// @param at      evaluation with gradients at x, and multipliers where other variables follow
  /// @param around  the sizes that the model's own are counted from
  LinearChoiceModel linear_model(const Eigen::VectorXd& x, const Result& at, const Sizes& around,
                                 int down, int up) const {
    const Evaluation& here = at.evaluation;
    const Eigen::Index rows = is_optimized_ ? 0 : here.constraints.size();
    LinearChoiceModel model{here.objective,        here.constraints.head(rows),
                            Eigen::VectorXd(rows), Eigen::VectorXd(rows),
                            scales_.head(rows),    {}};
    for (Eigen::Index j = 0; j < rows; ++j) {
      model.lower(j) = solution_.problem->constraints()[j].lower;
      model.upper(j) = solution_.problem->constraints()[j].upper;
    }
    Eigen::VectorXd slope = here.objective_gradient;
    if (is_optimized_ && at.constraint_multipliers.size() > 0) {
      slope += here.constraint_jacobian.transpose() * at.constraint_multipliers;
    }
    for (std::size_t k = 0; k < lists_.count(); ++k) {
      const Eigen::Index i = lists_.variable(k);
      const double gap = is_optimized_ ? lists_.mean_gap(k) : 0.0;
      const int first = std::max(0, around[k] + down);
      const int last = std::min(lists_.sizes(k) - 1, around[k] + up);
      std::vector<LinearOption>& options = model.options.emplace_back();
      for (int size = first; size <= last; ++size) {
        const double change = lists_.value(k, size) - x(i);
        options.push_back(
            {size, slope(i) * change + distance_cost(gap, change, report_.relaxed_objective),
             changed_limits(here.constraint_jacobian.col(i).head(rows), k, x(i), size)});
      }
    }
    return model;
  }

  /// What falls as a size grows, as a stress does, is taken to be linear in its reciprocal (Fleury &
  /// Braibant 1986): c' · (y − x) · x / y.
  /// @param slopes  of the limits by the k-th chosen variable, which is x
  Eigen::VectorXd changed_limits(const Eigen::VectorXd& slopes, std::size_t k, double x,
                                 int size) const {
    const double to = lists_.value(k, size), change = to - x;
    const double reciprocal = lists_.value(k, 0) > 0.0 && to > 0.0 ? x / to : 1.0;
    Eigen::VectorXd changes = slopes * change;
    for (double& one : changes) {
      if (one * change < 0.0) one *= reciprocal;
    }
    return changes;
  }

  /// Predicted to be better than the best so far, if that keeps its limits.
  bool is_promising(const PredictedChoice& one) const {
    if (!best_ || is_optimized_ || !tried_.at(*best_).keeps_limits()) return true;
    return one.objective < tried_.at(*best_).objective;
  }

  // ---- the answer

  void conclude() {
    const SizeTrial& best = tried_.at(*best_);
    const Result before = std::move(solution_.result);
    solution_.problem = setup_.problem_at(with_sizes(file_, best.x), best.x);
    const bool has_free = !std::ranges::all_of(solution_.problem->variables(), &Variable::is_fixed);
    Result result = run_after(before, setup_.observer, [&](const Observer& observer) {
      return has_free ? solve_design(*solution_.problem, setup_.options, observer, setup_.notice)
                      : judge_design(*solution_.problem, setup_.options, observer);
    });
    result.restarts = before.restarts;
    result.backend = before.backend;
    report_.is_choice = true;
    judge(result);
    solution_.result = std::move(result);
    show_all_choices();
  }

  /// Gradients are computed as they were so far.
  void keep_methods(DesignProblem& problem) const {
    for (std::size_t c = 0; c < problem.case_count(); ++c) {
      if (const auto& method = solution_.problem->load_case(c).method()) {
        problem.load_case(c).decide_method(*method);
      }
    }
  }

  /// Tables and pages show what there was to choose from, not the size that was taken.
  void show_all_choices() {
    ProblemFile file = solution_.problem->file();
    file.variables = file_.variables;
    auto problem = setup_.problem_at(std::move(file), start_design(file_));
    keep_methods(*problem);
    solution_.problem = std::move(problem);
  }

  void judge(Result& result) const {
    const double objective = result.evaluation.objective;
    const bool is_sound = result.status == Status::verified;
    if (result.max_violation > Tolerances().violation) {
      result.status = Status::infeasible;
      result.message = fmt::format(
          "{}; this one breaks them least ({:.2g} relative): {}",
          report_.is_exhaustive
              ? fmt::format("none of the {} choices of sizes keeps all limits (all tried)",
                            count_text(report_.combinations))
              : fmt::format("of {} choices of sizes that were tried none keeps all limits",
                            report_.tried),
          result.max_violation,
          broken_limits(*solution_.problem, result.evaluation.constraints, scales_,
                        Tolerances().violation));
      return;
    }
    const std::string what =
        report_.is_exhaustive
            ? fmt::format("the best of all {} choices of sizes (all tried, {} keep the limits)",
                          count_text(report_.combinations), report_.feasible)
            : fmt::format("the best choice of sizes that was found: {} of {} were tried, and {}",
                          report_.tried, count_text(report_.combinations),
                          !is_settled_ ? "the search was not at its end"
                          : report_.are_lists_tried
                              ? "none with one size exchanged is better"
                              : "none with one size exchanged for the next is better");
    if (is_sound && !report_.is_exhaustive && !is_settled_) result.status = Status::stalled;
    result.message =
        what + bound_text(objective) + (is_sound ? "" : fmt::format("; {}", result.message));
  }

  /// What the relaxation says of all choices.
  std::string bound_text(double objective) const {
    const std::string relaxed = objective_text(report_.relaxed_objective);
    const double penalty = report_.penalty(objective);
    if (report_.relaxed_status != Status::verified &&
        report_.relaxed_status != Status::unresolved) {
      return fmt::format("; between the sizes no optimum was verified ({} at {})", relaxed,
                         to_string(report_.relaxed_status));
    }
    if (penalty < -Tolerances().gain) {
      return fmt::format("; the optimum between the sizes, {}, is a local one that is worse",
                         relaxed);
    }
    const std::string price = fmt::format("; {} % worse than the optimum between the sizes, {}",
                                          significant(100.0 * std::max(penalty, 0.0), 2), relaxed);
    return report_.is_exhaustive
               ? price
               : price +
                     ", which no choice can beat if no other optimum between the sizes is better";
  }

  std::string objective_text(double objective) const {
    return solution_.problem->objective_text(objective);
  }

  static std::string count_text(double count) {
    return count < 1e6 ? fmt::format("{:.0f}", count) : fmt::format("{:.2g}", count);
  }

  StagedSolution& solution_;
  const ProblemFile file_;
  SearchSetup setup_;
  const SizeLists lists_;
  bool is_optimized_;
  Eigen::VectorXd scales_;
  std::map<Sizes, SizeTrial> tried_;
  std::optional<Sizes> best_;
  bool is_settled_ = false;
  SizeChoiceReport report_;
};

}  // namespace

double SizeChoiceReport::penalty(double objective) const {
  if (relaxed_objective == 0.0) return 0.0;
  return (objective - relaxed_objective) / std::abs(relaxed_objective);
}

bool has_choices(const ProblemFile& file) {
  return std::ranges::any_of(file.variables, &DesignVariable::has_choices);
}

bool keeps_choices(const ProblemFile& file, const Eigen::VectorXd& x) {
  for (std::size_t i = 0; i < file.variables.size(); ++i) {
    const std::vector<SizeChoice>& choices = file.variables[i].choices;
    const bool is_chosen =
        choices.empty() || std::ranges::count(choices, x(i), &SizeChoice::value) > 0;
    if (!is_chosen) return false;
  }
  return true;
}

SizeChoiceReport choose_sizes(StagedSolution& solution, const SearchSetup& setup) {
  return SizeSearch(solution, setup).run();
}

}  // namespace pleuel
