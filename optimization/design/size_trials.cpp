#include "optimization/design/size_trials.hpp"

#include <algorithm>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/base/stopwatch.hpp"
#include "core/jobs/parallel.hpp"
#include "core/scene/packed_problem.hpp"
#include "optimization/evaluation_store.hpp"
#include "optimization/result.hpp"
#include "optimization/scaling.hpp"
#include "optimization/solve.hpp"

namespace pleuel {

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

  ProblemFile file;
  std::vector<Eigen::VectorXd> designs;
  Eigen::VectorXd scales;
  SolveOptions options;

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

/// Hears of the trials.
class Trials : public StoredTasks<TrialData> {
 public:
  Trials(TrialData data, EvaluationStore* store)
      : StoredTasks(std::move(data), store), trials_(this->data().designs.size()) {}

  int count() const override { return int_size(trials_); }

  void take(int task, const std::string& answer) override {
    trials_[task] = unpacked<SizeTrial>(answer);
  }

  void fail(int task, const std::string& failure) override {
    trials_[task].x = data().designs[task];
    trials_[task].history = {only_record(data().designs[task], {std::nullopt, failure})};
  }

  std::vector<SizeTrial> take_trials() { return std::move(trials_); }

 private:
  std::vector<SizeTrial> trials_;
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
  Trials trials({file, designs, scales, options}, execution.store);
  run_tasks(trials, execution.tasks);
  return trials.take_trials();
}

std::unique_ptr<TaskWork> make_trial_work(const std::string& content) {
  return make_stored_work<TrialData>(content);
}

}  // namespace pleuel
