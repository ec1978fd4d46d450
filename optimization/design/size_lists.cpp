#include "optimization/design/size_lists.hpp"

#include <algorithm>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/base/stopwatch.hpp"
#include "core/jobs/parallel.hpp"
#include "core/scene/packed_problem.hpp"
#include "optimization/evaluation_store.hpp"
#include "optimization/scaling.hpp"
#include "optimization/solve.hpp"

namespace pleuel {

SizeLists::SizeLists(const std::vector<DesignVariable>& variables) {
  for (std::size_t i = 0; i < variables.size(); ++i) {
    if (!variables[i].has_choices()) continue;
    List list{static_cast<Eigen::Index>(i), {}};
    for (const SizeChoice& choice : variables[i].choices) list.values.push_back(choice.value);
    lists_.push_back(std::move(list));
  }
}

double SizeLists::mean_gap(std::size_t k) const {
  const std::vector<double>& values = lists_[k].values;
  if (values.size() < 2) return 0.0;
  return (values.back() - values.front()) / static_cast<double>(values.size() - 1);
}

double SizeLists::combinations() const {
  double product = 1.0;
  for (const List& list : lists_) product *= static_cast<double>(list.values.size());
  return product;
}

std::vector<Sizes> SizeLists::all() const {
  std::vector<Sizes> all;
  Sizes choice(count(), 0);
  for (bool is_new = true; is_new;) {
    all.push_back(choice);
    is_new = false;
    for (std::size_t k = count(); k-- > 0 && !is_new;) {
      is_new = ++choice[k] < sizes(k);
      if (!is_new) choice[k] = 0;
    }
  }
  return all;
}

Eigen::VectorXd SizeLists::design(const Sizes& choice, Eigen::VectorXd x) const {
  for (std::size_t k = 0; k < count(); ++k) x(variable(k)) = value(k, choice[k]);
  return x;
}

Sizes SizeLists::below(const Eigen::VectorXd& x) const {
  Sizes found(count(), 0);
  for (std::size_t k = 0; k < count(); ++k) {
    while (found[k] + 1 < sizes(k) && value(k, found[k] + 1) <= x(variable(k))) ++found[k];
  }
  return found;
}

Sizes SizeLists::nearest(const Eigen::VectorXd& x) const {
  Sizes found = below(x);
  for (std::size_t k = 0; k < count(); ++k) {
    const double at = x(variable(k));
    const bool has_next = found[k] + 1 < sizes(k);
    if (has_next && value(k, found[k] + 1) - at < at - value(k, found[k])) ++found[k];
  }
  return found;
}

std::vector<Sizes> SizeLists::exchanges(const Sizes& from, int reach) const {
  std::vector<Sizes> all;
  for (std::size_t k = 0; k < count(); ++k) {
    for (int size = 0; size < sizes(k); ++size) {
      if (size == from[k] || std::abs(size - from[k]) > reach) continue;
      all.push_back(from);
      all.back()[k] = size;
    }
  }
  return all;
}

namespace {

/// Of the only evaluation of a trial.
EvaluationRecord only_record(const Eigen::VectorXd& x, const Attempt& attempt) {
  EvaluationRecord record = record_of(x, Request::values, attempt);
  record.evaluation = 1;
  return record;
}

/// Choices to be tried, one a task.
struct TrialData {
  static constexpr const char* kind = trial_work_name;
  using Answer = SizeTrial;

  ProblemFile file;
  std::vector<Eigen::VectorXd> designs;
  Eigen::VectorXd scales;
  SolveOptions options;

  int count() const { return int_size(designs); }

  SizeTrial lost(int task, const std::string& failure) const {
    return {.x = designs[task], .history = {only_record(designs[task], {std::nullopt, failure})}};
  }

  std::string run(int task, const std::string& /*needed*/, TaskCaller& /*caller*/,
                  EvaluationStore* store) const {
    const Eigen::VectorXd& x = designs[task];
    return packed(needs_optimization(file) ? optimized(x, store) : simulated(x, store));
  }

 private:
  SizeTrial simulated(const Eigen::VectorXd& x, EvaluationStore* store) const {
    DesignProblem design(file, available_threads(), store);
    const Stopwatch stopwatch;
    const Attempt attempt = attempt_evaluation(design, x, Request::values);
    EvaluationRecord record = only_record(x, attempt);
    record.seconds = stopwatch.seconds();
    SizeTrial trial{.x = x, .objective = record.objective};
    if (attempt.evaluation) {
      record.max_violation = max_violation(design, record.constraints, scales);
      trial.max_violation = record.max_violation;
    }
    trial.constraints = record.constraints;
    trial.seconds = record.seconds;
    trial.history = {simulated_with(file, std::move(record))};
    return trial;
  }

  SizeTrial optimized(const Eigen::VectorXd& x, EvaluationStore* store) const {
    ProblemFile fixed = with_sizes(file, x);
    fixed.simulation.checks_resolution = false;  // of the answer alone
    DesignProblem design(std::move(fixed), available_threads(), store);
    design.start_from(x);
    const Result result = solve_design(design, options);
    SizeTrial trial;
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

}  // namespace

bool needs_optimization(const ProblemFile& file) {
  const auto is_free = [](const DesignVariable& variable) {
    return !variable.has_choices() && variable.lower < variable.upper;
  };
  return std::ranges::any_of(file.variables, is_free) ||
         std::ranges::any_of(file.constraints,
                             [](const ConstraintSettings& one) { return one.deviations > 0.0; });
}

ProblemFile with_sizes(ProblemFile file, const Eigen::VectorXd& x) {
  for (std::size_t i = 0; i < file.variables.size(); ++i) {
    DesignVariable& variable = file.variables[i];
    if (variable.has_choices()) variable.lower = variable.upper = x(i);
  }
  return file;
}

std::vector<SizeTrial> try_sizes(const ProblemFile& file,
                                 const std::vector<Eigen::VectorXd>& designs,
                                 const Eigen::VectorXd& scales, const SolveOptions& options,
                                 const Execution& execution) {
  AnsweredTasks<TrialData> trials({file, designs, scales, options}, execution.store);
  run_tasks(trials, execution.tasks);
  return trials.take_answers();
}

std::unique_ptr<TaskWork> make_trial_work(const std::string& content) {
  return make_stored_work<TrialData>(content);
}

}  // namespace pleuel
