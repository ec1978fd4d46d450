#include "studies/front_ends.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/scene/case_goals.hpp"
#include "core/scene/packed_problem.hpp"
#include "optimization/design/design_problem.hpp"
#include "optimization/evaluation_store.hpp"
#include "optimization/result.hpp"
#include "optimization/solve.hpp"
#include "studies/sized_search.hpp"

namespace pleuel {

namespace {

constexpr double least_part = 1e-4;  ///< of the range of a goal: a gain
constexpr double near_zero = 1e-6;   ///< of the accuracy: values below are round-off of 0

GoalScale scale_of(const std::vector<Goals>& front, std::size_t goal) {
  GoalScale scale;
  if (front.empty()) return scale;
  const auto [low, high] = std::minmax_element(
      front.begin(), front.end(),
      [&](const Goals& one, const Goals& other) { return one[goal] < other[goal]; });
  scale.low = (*low)[goal];
  scale.high = (*high)[goal];
  scale.accuracy = optimum_accuracy * std::max(std::abs(scale.low), std::abs(scale.high));
  return scale;
}

}  // namespace

double GoalScale::least_gain() const {
  return std::max(least_part * range(), accuracy);
}

double GoalScale::round_off(double one, double other) const {
  return std::max(equal_numbers * std::max(std::abs(one), std::abs(other)), near_zero * accuracy);
}

FrontScale::FrontScale(const std::vector<Goals>& designs) {
  const std::vector<bool> counts = non_dominated(designs);
  std::vector<Goals> front;
  for (std::size_t i = 0; i < designs.size(); ++i) {
    if (counts[i]) front.push_back(designs[i]);
  }
  goals_ = {scale_of(front, 0), scale_of(front, 1)};
}

bool FrontScale::dominates(const Goals& one, const Goals& other, Limits limits) const {
  bool is_better = false;
  for (std::size_t i = 0; i < 2; ++i) {
    const double gain = other[i] - one[i];
    const bool is_kept_alike = i == 1 && limits == Limits::same;
    const double allowed =
        is_kept_alike ? goals_[i].least_gain() : goals_[i].round_off(one[i], other[i]);
    if (gain < -allowed) return false;
    is_better = is_better || gain > goals_[i].least_gain();
  }
  return is_better;
}

bool is_no_better(double one, double other) {
  return one >= other - equal_numbers * std::max(std::abs(one), std::abs(other));
}

std::vector<bool> non_dominated(const std::vector<Goals>& goals) {
  std::vector<bool> marks;
  for (const Goals& one : goals) {
    marks.push_back(std::none_of(goals.begin(), goals.end(), [&](const Goals& other) {
      const bool is_nowhere_worse =
          is_no_better(one[0], other[0]) && is_no_better(one[1], other[1]);
      const bool is_somewhere_better =
          !is_no_better(other[0], one[0]) || !is_no_better(other[1], one[1]);
      return is_nowhere_worse && is_somewhere_better;
    }));
  }
  return marks;
}

namespace {

/// By how much goals may be missed where the other one is improved, relative to their value.
constexpr double end_tolerance = 1e-4;

double signed_value(const Objective& goal, double value) {
  return goal.sign() * value;
}

/// The file with another objective, and at most this value (of what is maximized at least) of
/// another response.
ProblemFile with_goal(ProblemFile file, const Objective& goal,
                      const std::optional<std::pair<Objective, double>>& limit) {
  set_objective(file, goal);
  if (limit) add_limit(file, limit->first, limit->second, limit->first.response);
  return file;
}

/// Of the objective; 0 if no design could be simulated.
double first_value(const History& history) {
  const auto first = std::find_if_not(history.begin(), history.end(),
                                      [](const auto& record) { return record.has_failed(); });
  return first == history.end() ? 0.0 : first->objective;
}

/// Searches that each are a file and a start.
struct EndData {
  static constexpr const char* kind = end_work_name;

  std::vector<ProblemFile> files;
  std::vector<Eigen::VectorXd> starts;
  SolveOptions options;

  std::string run(int task, const std::string& /*needed*/, TaskCaller& /*caller*/,
                  EvaluationStore* store) const {
    ProblemFile file = files[task];
    start_from(starts[task], file.variables);
    SizedDesign best = search_with_sizes(file, options, store);
    DesignProblem& design = *best.problem;
    FrontEnd end;
    end.result = std::move(best.result);
    end.sizes = best.sizes;
    end.start_value = first_value(end.result.history);
    if (end.result.evaluation.has_gradients()) {
      for (std::size_t i = 0; i < 2; ++i) {
        const std::size_t response = design.response_index(file.pareto->goals[i].response);
        end.values[i] = design.value_at(end.result.x, response);
      }
    }
    return packed(end);
  }
};

class EndSearches : public StoredTasks<EndData> {
 public:
  EndSearches(EndData data, EvaluationStore* store)
      : StoredTasks(std::move(data), store), ends_(this->data().files.size()) {}

  int count() const override { return int_size(ends_); }

  void take(int task, const std::string& answer) override {
    ends_[task] = unpacked<FrontEnd>(answer);
  }

  void fail(int task, const std::string& failure) override {
    ends_[task].result.message = "the search was lost: " + failure;
    ends_[task].result.x = data().starts[task];
  }

  std::vector<FrontEnd> take_ends() { return std::move(ends_); }

 private:
  std::vector<FrontEnd> ends_;
};

bool keeps_limits(const Result& result) {
  return result.evaluation.has_gradients() && result.max_violation <= Tolerances().violation;
}

/// What the best of a response may lose for the good of the other one: a share of its value, which may
/// be much smaller than the front is long, but no less than round-off of the front. Of a response
/// that is the same at both ends all that cannot be told apart.
double end_slack(double value, const GoalScale& scale) {
  if (!scale.is_traded()) return scale.accuracy;
  return end_tolerance * std::clamp(std::abs(value), 1e-4 * scale.range(), scale.range());
}

/// An end whose other response is better, if there is one that is as good.
void refine(FrontEnd& end, const FrontEnd& refined, const Objective& other, std::size_t index,
            const GoalScale& scale) {
  if (!keeps_limits(refined.result)) return;
  const double gain =
      signed_value(other, end.values[index]) - signed_value(other, refined.values[index]);
  if (gain <= (scale.is_traded() ? 10.0 * end_tolerance * scale.range() : scale.accuracy)) return;
  end.result = refined.result;
  end.values = refined.values;
  end.sizes = refined.sizes;
}

}  // namespace

void start_from(const Eigen::VectorXd& x, std::vector<DesignVariable>& variables) {
  for (std::size_t i = 0; i < variables.size(); ++i) {
    variables[i].start = std::clamp(x(i), variables[i].lower, variables[i].upper);
  }
}

GoalScale end_scale(const std::vector<FrontEnd>& ends, std::size_t goal) {
  GoalScale scale;
  const double first = ends[0].values[goal], second = ends[1].values[goal];
  scale.low = std::min(first, second);
  scale.high = std::max(first, second);
  scale.accuracy =
      std::max({optimum_accuracy * std::abs(scale.low), optimum_accuracy * std::abs(scale.high),
                equal_numbers * std::abs(ends[goal].start_value)});
  return scale;
}

std::unique_ptr<TaskWork> make_end_work(const std::string& content) {
  return make_stored_work<EndData>(content);
}

std::vector<FrontEnd> find_front_ends(const ProblemFile& file, const SolveOptions& options,
                                      const Execution& execution) {
  const std::vector<Objective>& goals = file.pareto->goals;
  const Eigen::VectorXd start = start_design(file);
  EndSearches first(
      {{with_goal(file, goals[0], std::nullopt), with_goal(file, goals[1], std::nullopt)},
       {start, start},
       options},
      execution.store);
  run_tasks(first, execution.tasks);
  std::vector<FrontEnd> ends = first.take_ends();
  if (!keeps_limits(ends[0].result) || !keeps_limits(ends[1].result)) return ends;
  std::vector<ProblemFile> files;
  const std::array<GoalScale, 2> scales = {end_scale(ends, 0), end_scale(ends, 1)};
  if (!scales[0].is_traded() && !scales[1].is_traded()) return ends;
  for (std::size_t i = 0; i < 2; ++i) {
    const double slack = end_slack(ends[i].values[i], scales[i]);
    const double limit = ends[i].values[i] + goals[i].sign() * slack;
    files.push_back(with_goal(file, goals[1 - i], std::pair(goals[i], limit)));
  }
  EndSearches second({files, {ends[0].result.x, ends[1].result.x}, options}, execution.store);
  run_tasks(second, execution.tasks);
  const std::vector<FrontEnd> refined = second.take_ends();
  for (std::size_t i = 0; i < 2; ++i)
    refine(ends[i], refined[i], goals[1 - i], 1 - i, scales[1 - i]);
  return ends;
}

}  // namespace pleuel
