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

std::vector<Sizes> SizeLists::neighbours(const Sizes& from) const {
  std::vector<Sizes> all;
  for (std::size_t k = 0; k < count(); ++k) {
    for (const int step : {-1, 1}) {
      Sizes one = from;
      one[k] += step;
      if (one[k] >= 0 && one[k] < sizes(k)) all.push_back(std::move(one));
    }
  }
  return all;
}

std::vector<Sizes> SizeLists::exchanges(const Sizes& from) const {
  std::vector<Sizes> all;
  for (std::size_t k = 0; k < count(); ++k) {
    for (int size = 0; size < sizes(k); ++size) {
      if (size == from[k]) continue;
      all.push_back(from);
      all.back()[k] = size;
    }
  }
  return all;
}

namespace {

/// dy / dx of what is linear in 1 / x, over that of what is linear in x.
double reciprocal(const SizeLists& lists, std::size_t k, double from, double to) {
  const bool is_size = lists.value(k, 0) > 0.0 && to > 0.0;
  return is_size ? from / to : 1.0;
}

/// Where slopes vanish, as at an optimum between the sizes, the nearer size is the better guess.
double distance_cost(double gap, double change, double objective) {
  if (gap == 0.0) return 0.0;
  return 1e-3 * std::abs(objective) * (change / gap) * (change / gap);
}

/// Rows of constraints, and their limits; without options.
LinearChoiceModel model_at(const Problem& problem, const Evaluation& at, Eigen::Index rows,
                           const Eigen::VectorXd& scales) {
  LinearChoiceModel model;
  model.objective = at.objective;
  model.constraints = at.constraints.head(rows);
  model.lower.resize(rows);
  model.upper.resize(rows);
  model.scales = scales.head(rows);
  for (Eigen::Index j = 0; j < rows; ++j) {
    model.lower(j) = problem.constraints()[j].lower;
    model.upper(j) = problem.constraints()[j].upper;
  }
  return model;
}

}  // namespace

LinearChoiceModel size_model(const SizeLists& lists, const Problem& problem,
                             const Eigen::VectorXd& x, const Result& at, const Sizes& around,
                             const Eigen::VectorXd& scales, const SizeModelSettings& settings) {
  const Eigen::Index rows = settings.is_reduced ? 0 : at.evaluation.constraints.size();
  LinearChoiceModel model = model_at(problem, at.evaluation, rows, scales);
  Eigen::VectorXd slope = at.evaluation.objective_gradient;
  if (settings.is_reduced && at.constraint_multipliers.size() > 0) {
    slope += at.evaluation.constraint_jacobian.transpose() * at.constraint_multipliers;
  }
  for (std::size_t k = 0; k < lists.count(); ++k) {
    const Eigen::Index i = lists.variable(k);
    const double gap = settings.is_reduced ? lists.mean_gap(k) : 0.0;
    const int first = std::max(0, around[k] + settings.down);
    const int last = std::min(lists.sizes(k) - 1, around[k] + settings.up);
    std::vector<LinearOption> options;
    for (int size = first; size <= last; ++size) {
      const double change = lists.value(k, size) - x(i);
      Eigen::VectorXd constraints = at.evaluation.constraint_jacobian.col(i).head(rows) * change;
      for (Eigen::Index j = 0; j < rows; ++j) {
        if (constraints(j) * change < 0.0) {
          constraints(j) *= reciprocal(lists, k, x(i), lists.value(k, size));
        }
      }
      options.push_back({size,
                         slope(i) * change + distance_cost(gap, change, settings.relaxed_objective),
                         std::move(constraints)});
    }
    model.options.push_back(std::move(options));
  }
  return model;
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

bool is_better(const SizeTrial& one, const SizeTrial& other) {
  if (one.keeps_limits() != other.keeps_limits()) return one.keeps_limits();
  return one.keeps_limits() ? one.objective < other.objective
                            : one.max_violation < other.max_violation;
}

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
