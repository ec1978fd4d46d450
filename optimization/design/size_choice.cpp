#include "optimization/design/size_choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "core/base/number_text.hpp"
#include "core/base/parallel.hpp"
#include "core/base/stopwatch.hpp"
#include "core/base/tasks.hpp"
#include "core/scene/packed_problem.hpp"
#include "optimization/broken_limits.hpp"
#include "optimization/linear_choice.hpp"
#include "optimization/packed_options.hpp"
#include "optimization/packed_result.hpp"
#include "optimization/scaling.hpp"

namespace pleuel {

namespace {

/// Choices that are all tried: each costs a simulation, or an optimization.
constexpr double most_simulated = 300.0, most_optimized = 16.0;
/// That a linear model proposes at a time.
constexpr std::size_t proposals = 8, optimized_proposals = 3;
constexpr int most_rounds_of_choice = 25;
/// Batches of proposals of one model.
constexpr int most_batches = 6;
/// Sizes up and down that a linear model looks at.
constexpr int reach = 2;

using Sizes = std::vector<int>;  ///< place in its list, by chosen variable

/// A choice that was tried.
struct Trial {
  Eigen::VectorXd x;  ///< [SI]
  double objective = 0.0, max_violation = std::numeric_limits<double>::infinity();
  Eigen::VectorXd constraints;
  History history;
  double seconds = 0.0;

  bool has_failed() const { return constraints.size() == 0 && !std::isfinite(max_violation); }
  bool keeps_limits() const { return max_violation <= Tolerances().violation; }
};

template <class Archive>
void transfer(Archive& archive, Trial& trial) {
  auto& [x, objective, violation, constraints, history, seconds] = trial;
  archive(x, objective, violation, constraints, history, seconds);
}

bool is_better(const Trial& one, const Trial& other) {
  if (one.keeps_limits() != other.keeps_limits()) return one.keeps_limits();
  return one.keeps_limits() ? one.objective < other.objective
                            : one.max_violation < other.max_violation;
}

std::vector<std::size_t> chosen_variables(const ProblemFile& file) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < file.variables.size(); ++i) {
    if (file.variables[i].has_choices()) chosen.push_back(i);
  }
  return chosen;
}

/// Whether each choice has to be optimized: there are other variables, or margins that follow from
/// gradients.
bool needs_optimization(const ProblemFile& file) {
  return std::any_of(file.variables.begin(), file.variables.end(),
                     [](const DesignVariable& variable) {
                       return !variable.has_choices() && variable.lower < variable.upper;
                     }) ||
         std::any_of(file.constraints.begin(), file.constraints.end(),
                     [](const ConstraintSettings& one) { return one.deviations > 0.0; });
}

/// The problem with these sizes fixed. Its start stays: what the model decides there stays too.
ProblemFile with_sizes(ProblemFile file, const Eigen::VectorXd& x) {
  for (std::size_t i = 0; i < file.variables.size(); ++i) {
    DesignVariable& variable = file.variables[i];
    if (variable.has_choices()) variable.lower = variable.upper = x(i);
  }
  return file;
}

EvaluationRecord failed_record(const Eigen::VectorXd& x, const std::string& failure) {
  EvaluationRecord record;
  record.evaluation = 1;
  record.x = x;
  record.failure = failure;
  return record;
}

/// Choices to be tried, one a task.
class TrialWork : public TaskWork {
 public:
  ProblemFile file;
  std::vector<Eigen::VectorXd> designs;
  Eigen::VectorXd scales;
  SolveOptions options;
  bool has_store = false;

  std::string run(int task, const std::string& /*needed*/, TaskCaller& caller) override {
    RemoteStore store(caller);
    EvaluationStore* known = has_store ? &store : nullptr;
    const Eigen::VectorXd& x = designs[task];
    return packed(needs_optimization(file) ? optimized(x, known) : simulated(x, known));
  }

 private:
  Trial simulated(const Eigen::VectorXd& x, EvaluationStore* store) const {
    DesignProblem design(file, available_threads(), store);
    const Stopwatch stopwatch;
    const Attempt attempt = attempt_evaluation(design, x, Request::values);
    Trial trial;
    trial.x = x;
    EvaluationRecord record = failed_record(x, attempt.failure);
    if (attempt.evaluation) {
      trial.objective = record.objective = attempt.evaluation->objective;
      trial.constraints = record.constraints = attempt.evaluation->constraints;
      trial.max_violation = record.max_violation = max_violation(design, trial.constraints, scales);
    }
    trial.seconds = record.seconds = stopwatch.seconds();
    trial.history = {simulated_with(file, std::move(record))};
    return trial;
  }

  Trial optimized(const Eigen::VectorXd& x, EvaluationStore* store) const {
    ProblemFile fixed = with_sizes(file, x);
    fixed.simulation.checks_resolution = false;  // of the answer alone
    DesignProblem design(std::move(fixed), available_threads(), store);
    design.start_from(x);
    const Result result = solve_design(design, options);
    Trial trial;
    trial.x = result.x;
    trial.history = result.history;
    trial.seconds = result.seconds;
    if (!result.evaluation.has_gradients()) return trial;
    trial.objective = result.evaluation.objective;
    trial.constraints = result.evaluation.constraints;
    trial.max_violation = result.max_violation;
    return trial;
  }
};

/// Hears of the trials.
class Trials : public Tasks {
 public:
  Trials(const ProblemFile& file, const std::vector<Eigen::VectorXd>& designs,
         const Eigen::VectorXd& scales, const SolveOptions& options, const Execution& execution)
      : execution_(execution), trials_(designs.size()) {
    work_.file = file;
    work_.designs = designs;
    work_.scales = scales;
    work_.options = options;
    work_.has_store = execution.store != nullptr;
  }

  int count() const override { return static_cast<int>(trials_.size()); }

  PackedWork packed_work() const override {
    return {trial_work_name,
            packed(work_.file, work_.designs, work_.scales, work_.options, work_.has_store)};
  }

  std::string run(int task, const std::string& needed, TaskCaller& caller) override {
    return work_.run(task, needed, caller);
  }

  std::string reply(int /*task*/, const std::string& question) override {
    return reply_of(*execution_.store, question);
  }

  void take(int task, const std::string& answer) override {
    trials_[task] = unpacked<Trial>(answer);
  }

  void fail(int task, const std::string& failure) override {
    trials_[task].x = work_.designs[task];
    trials_[task].history = {failed_record(work_.designs[task], failure)};
  }

  std::vector<Trial> take_trials() { return std::move(trials_); }

 private:
  TrialWork work_;
  const Execution& execution_;
  std::vector<Trial> trials_;
};

class SizeSearch {
 public:
  SizeSearch(StagedSolution& solution, const SolveOptions& options, const Execution& execution,
             const Observer& observer, const Notice& notice)
      : solution_(solution),
        file_(solution.problem->file()),
        options_(options),
        execution_(execution),
        observer_(observer),
        notice_(notice),
        chosen_(chosen_variables(file_)),
        is_optimized_(needs_optimization(file_)) {
    options_.starts = 1;
    const Result& relaxed = solution.result;
    report_.relaxed_status = relaxed.status;
    report_.relaxed_objective = relaxed.evaluation.objective;
    report_.relaxed_x = relaxed.x;
    for (const std::size_t i : chosen_) {
      report_.combinations *= static_cast<double>(file_.variables[i].choices.size());
    }
  }

  SizeChoiceReport run() {
    if (!solution_.result.evaluation.has_gradients()) return report_;  // the start failed
    const DesignProblem& problem = *solution_.problem;
    scales_ = constraint_scales(problem, solution_.result.evaluation,
                                variable_scales(problem, solution_.result.x));
    const double most = is_optimized_ ? most_optimized : most_simulated;
    report_.is_exhaustive = report_.combinations <= most;
    notify(fmt::format(
        "the optimum between the sizes has {} = {} ({})", problem.file().objective->response,
        objective_text(report_.relaxed_objective), to_string(report_.relaxed_status)));
    if (report_.is_exhaustive) {
      notify(fmt::format("all {} choices are tried", report_.combinations));
      try_all();
    } else {
      search();
    }
    if (best_) conclude();
    return report_;
  }

 private:
  // ---- designs

  double value(std::size_t k, int size) const {
    return file_.variables[chosen_[k]].choices[static_cast<std::size_t>(size)].value;
  }
  int sizes(std::size_t k) const {
    return static_cast<int>(file_.variables[chosen_[k]].choices.size());
  }

  Eigen::VectorXd design(const Sizes& choice, Eigen::VectorXd x) const {
    for (std::size_t k = 0; k < chosen_.size(); ++k) {
      x(static_cast<Eigen::Index>(chosen_[k])) = value(k, choice[k]);
    }
    return x;
  }

  /// The sizes at or below those of a design.
  Sizes below(const Eigen::VectorXd& x) const {
    Sizes found(chosen_.size(), 0);
    for (std::size_t k = 0; k < chosen_.size(); ++k) {
      const double at = x(static_cast<Eigen::Index>(chosen_[k]));
      while (found[k] + 1 < sizes(k) && value(k, found[k] + 1) <= at) ++found[k];
    }
    return found;
  }

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
    for (const Sizes& choice : news) designs.push_back(design(choice, from));
    Trials trials(file_, designs, scales_, options_, execution_);
    run_tasks(trials, execution_.tasks);
    std::vector<Trial> answers = trials.take_trials();
    for (std::size_t i = 0; i < news.size(); ++i) keep(news[i], std::move(answers[i]));
  }

  void keep(const Sizes& choice, Trial trial) {
    add_effort(trial);
    trial.history.clear();
    ++report_.tried;
    if (trial.keeps_limits()) ++report_.feasible;
    const Trial& kept = tried_.emplace(choice, std::move(trial)).first->second;
    if (!kept.has_failed() && (!best_ || is_better(kept, tried_.at(*best_)))) best_ = choice;
  }

  /// The effort of the whole run, in the relaxed result.
  void add_effort(Trial& trial) {
    Result& all = solution_.result;
    for (EvaluationRecord& record : trial.history) {
      record = following(std::move(record), all);
      if (observer_) observer_(record);
    }
    for (const EvaluationRecord& record : trial.history) {
      ++all.evaluations;
      if (record.request == Request::values_and_gradients) ++all.gradient_evaluations;
      all.iterations = std::max(all.iterations, record.iteration);
    }
    all.seconds += trial.seconds;
    all.history.insert(all.history.end(), trial.history.begin(), trial.history.end());
  }

  void try_all() {
    std::vector<Sizes> all;
    Sizes choice(chosen_.size(), 0);
    for (bool is_new = true; is_new;) {
      all.push_back(choice);
      is_new = false;
      for (std::size_t k = chosen_.size(); k-- > 0 && !is_new;) {
        is_new = ++choice[k] < sizes(k);
        if (!is_new) choice[k] = 0;
      }
    }
    attempt(all, report_.relaxed_x);
  }

  // ---- search

  void search() {
    propose(report_.relaxed_x, solution_.result, below(report_.relaxed_x), 0, 1);
    if (!best_) attempt({below(report_.relaxed_x), nearest(report_.relaxed_x)}, report_.relaxed_x);
    for (int round = 0; best_ && round < most_rounds_of_choice; ++round) {
      const Sizes from = *best_;
      const Eigen::VectorXd x = tried_.at(from).x;
      const auto around = linearized(from);
      for (int batch = 0; around && batch < most_batches && *best_ == from; ++batch) {
        const int before = report_.tried;
        propose(x, *around, from, -reach, reach);
        if (report_.tried == before) break;
      }
      if (*best_ == from) attempt(neighbours(from), x);
      if (*best_ == from) {
        is_settled_ = true;
        return;
      }
      notify(fmt::format("after {} choices: {} = {}{}", report_.tried, file_.objective->response,
                         objective_text(tried_.at(*best_).objective),
                         tried_.at(*best_).keeps_limits() ? "" : ", outside the limits"));
    }
  }

  Sizes nearest(const Eigen::VectorXd& x) const {
    Sizes found = below(x);
    for (std::size_t k = 0; k < chosen_.size(); ++k) {
      const double at = x(static_cast<Eigen::Index>(chosen_[k]));
      const bool has_next = found[k] + 1 < sizes(k);
      if (has_next && value(k, found[k] + 1) - at < at - value(k, found[k])) ++found[k];
    }
    return found;
  }

  /// Each size one up or down.
  std::vector<Sizes> neighbours(const Sizes& from) const {
    std::vector<Sizes> all;
    for (std::size_t k = 0; k < chosen_.size(); ++k) {
      for (const int step : {-1, 1}) {
        Sizes one = from;
        one[k] += step;
        if (one[k] >= 0 && one[k] < sizes(k)) all.push_back(std::move(one));
      }
    }
    return all;
  }

  /// Values and gradients at the best choice; multipliers where other variables were optimized.
  std::optional<Result> linearized(const Sizes& from) {
    const Eigen::VectorXd& x = tried_.at(from).x;
    DesignProblem problem(file_, execution_.tasks.jobs, execution_.store);
    keep_methods(problem);
    Result result;
    result.x = x;
    const Stopwatch stopwatch;
    Attempt attempt = attempt_evaluation(problem, x, Request::values_and_gradients);
    Trial effort;
    EvaluationRecord record;
    record.evaluation = record.iteration = 1;
    record.purpose = Purpose::audit;
    record.request = Request::values_and_gradients;
    record.x = x;
    record.failure = attempt.failure;
    if (attempt.evaluation) {
      record.objective = attempt.evaluation->objective;
      record.constraints = attempt.evaluation->constraints;
      record.max_violation = tried_.at(from).max_violation;
    }
    effort.seconds = record.seconds = stopwatch.seconds();
    effort.history = {simulated_with(file_, std::move(record))};
    add_effort(effort);
    if (!attempt.evaluation) return std::nullopt;
    result.evaluation = std::move(*attempt.evaluation);
    if (is_optimized_) {
      const ProblemFile fixed = with_sizes(file_, x);
      const DesignProblem others(fixed);
      result.constraint_multipliers =
          audit_kkt(others, {x, result.evaluation, tried_.at(from).max_violation},
                    result.evaluation, scales_)
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

  /// Predicted to be better than the best so far, if that keeps its limits.
  bool is_promising(const PredictedChoice& one) const {
    if (!best_ || is_optimized_ || !tried_.at(*best_).keeps_limits()) return true;
    return one.objective < tried_.at(*best_).objective;
  }

  LinearChoiceModel linear_model(const Eigen::VectorXd& x, const Result& at, const Sizes& around,
                                 int down, int up) const {
    const Eigen::Index rows = is_optimized_ ? 0 : at.evaluation.constraints.size();
    LinearChoiceModel model;
    model.objective = at.evaluation.objective;
    model.constraints = at.evaluation.constraints.head(rows);
    model.lower.resize(rows);
    model.upper.resize(rows);
    model.scales = scales_.head(rows);
    for (Eigen::Index j = 0; j < rows; ++j) {
      model.lower(j) = solution_.problem->constraints()[static_cast<std::size_t>(j)].lower;
      model.upper(j) = solution_.problem->constraints()[static_cast<std::size_t>(j)].upper;
    }
    // Where other variables follow, what they cost is in the multipliers: df = (∇f + Jᵀμ) · dx.
    Eigen::VectorXd slope = at.evaluation.objective_gradient;
    if (is_optimized_ && at.constraint_multipliers.size() > 0) {
      slope += at.evaluation.constraint_jacobian.transpose() * at.constraint_multipliers;
    }
    for (std::size_t k = 0; k < chosen_.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(chosen_[k]);
      std::vector<LinearOption> options;
      for (int size = std::max(0, around[k] + down); size <= std::min(sizes(k) - 1, around[k] + up);
           ++size) {
        const double change = value(k, size) - x(i);
        Eigen::VectorXd constraints = at.evaluation.constraint_jacobian.col(i).head(rows) * change;
        for (Eigen::Index j = 0; j < rows; ++j) {
          if (constraints(j) * change < 0.0) constraints(j) *= reciprocal(k, x(i), value(k, size));
        }
        options.push_back(
            {size, slope(i) * change + distance_cost(k, change), std::move(constraints)});
      }
      model.options.push_back(std::move(options));
    }
    return model;
  }

  /// What falls as a size grows, as a stress does, is taken to be linear in its reciprocal (Fleury &
  /// Braibant 1986): c' · (y − x) · x / y.
  double reciprocal(std::size_t k, double from, double to) const {
    const bool is_size = value(k, 0) > 0.0 && to > 0.0;
    return is_size ? from / to : 1.0;
  }

  /// Where slopes vanish, as at an optimum between the sizes, the nearer size is the better guess.
  double distance_cost(std::size_t k, double change) const {
    if (!is_optimized_ || sizes(k) < 2) return 0.0;
    const double gap = (value(k, sizes(k) - 1) - value(k, 0)) / (sizes(k) - 1);
    return 1e-3 * std::abs(report_.relaxed_objective) * (change / gap) * (change / gap);
  }

  // ---- the answer

  void conclude() {
    const Trial& best = tried_.at(*best_);
    const Result before = std::move(solution_.result);
    solution_.problem = std::make_unique<DesignProblem>(with_sizes(file_, best.x),
                                                        execution_.tasks.jobs, execution_.store);
    solution_.problem->start_from(best.x);
    const Observer observe = [&](const EvaluationRecord& record) {
      if (observer_) observer_(following(record, before));
    };
    const bool has_free =
        std::any_of(solution_.problem->variables().begin(), solution_.problem->variables().end(),
                    [](const Variable& variable) { return !variable.is_fixed(); });
    Result result = has_free ? solve_design(*solution_.problem, options_, observe, notice_)
                             : judge_design(*solution_.problem, options_, observe);
    continue_from(before, result);
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
    auto problem =
        std::make_unique<DesignProblem>(std::move(file), execution_.tasks.jobs, execution_.store);
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
                          is_settled_ ? "none with one size exchanged for the next is better"
                                      : "the search was not at its end");
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

  void notify(const std::string& text) const {
    if (notice_) notice_(text);
  }

  StagedSolution& solution_;
  const ProblemFile file_;
  SolveOptions options_;
  const Execution& execution_;
  const Observer& observer_;
  const Notice& notice_;
  std::vector<std::size_t> chosen_;
  bool is_optimized_;
  Eigen::VectorXd scales_;
  std::map<Sizes, Trial> tried_;
  std::optional<Sizes> best_;
  bool is_settled_ = false;
  SizeChoiceReport report_;
};

}  // namespace

std::unique_ptr<TaskWork> make_trial_work(const std::string& content) {
  auto work = std::make_unique<TrialWork>();
  unpack(content, work->file, work->designs, work->scales, work->options, work->has_store);
  return work;
}

double SizeChoiceReport::penalty(double objective) const {
  if (relaxed_objective == 0.0) return 0.0;
  return (objective - relaxed_objective) / std::abs(relaxed_objective);
}

bool has_choices(const ProblemFile& file) {
  return std::any_of(file.variables.begin(), file.variables.end(),
                     [](const DesignVariable& variable) { return variable.has_choices(); });
}

bool keeps_choices(const ProblemFile& file, const Eigen::VectorXd& x) {
  for (std::size_t i = 0; i < file.variables.size(); ++i) {
    const std::vector<SizeChoice>& choices = file.variables[i].choices;
    if (choices.empty()) continue;
    if (std::none_of(choices.begin(), choices.end(),
                     [&](const SizeChoice& one) { return one.value == x(i); })) {
      return false;
    }
  }
  return true;
}

SizeChoiceReport choose_sizes(StagedSolution& solution, const SolveOptions& options,
                              const Execution& execution, const Observer& observer,
                              const Notice& notice) {
  return SizeSearch(solution, options, execution, observer, notice).run();
}

}  // namespace pleuel
