#include "core/trust/setting_choice.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "core/base/error.hpp"
#include "core/base/relative_error.hpp"
#include "core/trust/asked_responses.hpp"
#include "core/trust/error_bars.hpp"

namespace pleuel {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

constexpr double coarse_steps = 256.0;
/// Bounds of the refinement of step and elements, and of the work of one simulation, relative to
/// the file.
constexpr double finest_step = 1.0 / 16.0, most_elements = 8.0, most_work = 16.0;
constexpr int most_tries = 12;

/// Shares of the target that a new step and new elements aim at.
constexpr double step_aim = 0.5, elements_aim = 0.25;
/// Steps that are tried on the way back grow by this, and the step of the search at most by that.
constexpr double growth = 1.4, most_growth = 8.0;
/// Of the target: what a setting on the way back may make of it, by comparison with one that does.
/// The bars that judge it later are wider than its error.
constexpr double back_share = 0.5;

double number_of_steps(const SimulationSettings& settings) {
  return std::ceil(settings.end_time / settings.step * (1 - 1e-12));
}

/// A setting that was tried, with what the next one follows from.
struct Trial {
  TriedSetting tried;
  double by_step = infinite, by_elements = infinite;  ///< parts of errors; infinite: not resolved
  std::optional<int> fewest_elements;
  Eigen::VectorXd values;  ///< of the responses; empty: not simulated

  const Refinement& setting() const { return tried.setting; }
};

class Search {
 public:
  Search(const ProblemFile& problem, const Eigen::VectorXd& x, double target)
      : problem_(problem), x_(x), target_(target), asked_(asked_responses(problem)) {}

  SettingChoice run(const Refinement& first) {
    Trial best = refine(first);
    if (is_met(best)) {
      best = with_larger_step(std::move(best));
      best = with_fewer_elements(std::move(best));
    }
    SettingChoice choice;
    choice.is_met = is_met(best);
    choice.chosen = best.tried;
    choice.problem = refined(problem_, best.setting());
    choice.tried = std::move(tried_);
    return choice;
  }

 private:
  bool is_met(const Trial& trial) const { return trial.tried.error <= target_; }

  /// From coarse to fine, up to a setting that does, or the finest one that was tried.
  Trial refine(Refinement next) {
    Trial trial;
    for (int i = 0; i < most_tries && is_within_bounds(next); ++i) {
      trial = measure(next);
      const bool seems_met = is_met(trial);
      if (seems_met) trial.tried.error = std::max(trial.tried.error, distance_to_finer(trial));
      if (is_met(trial)) break;
      if (seems_met) trial.by_step = infinite;  // runs agreed by accident
      next = finer(trial);
    }
    return trial;
  }

  /// Judged by the product of steps and elements.
  static bool is_within_bounds(const Refinement& setting) {
    return setting.step >= finest_step && setting.elements <= most_elements &&
           setting.elements / setting.step <= most_work;
  }

  Refinement finer(const Trial& trial) const {
    const double by_step = trial.by_step / target_, by_elements = trial.by_elements / target_;
    Refinement next = trial.setting();
    if (!std::isfinite(by_step)) {
      next.step *= 0.5;
      return next;  // what elements change is known once steps are resolved
    }
    if (by_step > step_aim) next.step *= std::clamp(std::sqrt(step_aim / by_step), 0.125, 0.8);
    if (by_elements > 1.0 - step_aim) {
      next.elements *= std::sqrt(by_elements / elements_aim) > 2.0 ? 4.0 : 2.0;
    }
    if (by_step <= step_aim && by_elements <= 1.0 - step_aim) next.step *= 0.7;
    return next;
  }

  /// Back to larger steps, as long as their values are those of one that does.
  Trial with_larger_step(Trial fine) {
    Trial best = fine;
    Refinement next = fine.setting();
    while (next.step < most_growth * fine.setting().step) {
      next.step *= growth;
      std::optional<Trial> larger = beside(next, fine);
      if (!larger) break;
      best = std::move(*larger);
    }
    return best;
  }

  Trial with_fewer_elements(Trial fine) {
    Refinement fewer = fine.setting();
    fewer.elements *= 0.5;
    if (fine.fewest_elements.value_or(1) < 2) return fine;
    const std::optional<Trial> found = beside(fewer, fine);
    return found ? *found : fine;
  }

  /// A coarser setting, if its values are those of one that does.
  std::optional<Trial> beside(const Refinement& setting, const Trial& fine) {
    Trial trial = simulate(setting, [](const ProblemFile&, const Analysis&, Trial&) {});
    const double error = distance(trial.values, fine) + fine.tried.error;
    trial.tried.error = error;
    trial.tried.response = fine.tried.response;
    trial.fewest_elements = fine.fewest_elements;
    tried_.push_back(trial.tried);
    return error <= back_share * target_ ? std::optional(trial) : std::nullopt;
  }

  Trial measure(const Refinement& setting) {
    Trial trial = simulate(setting, [this](const ProblemFile& divided, const Analysis& analysis,
                                           Trial& one) { judge(divided, analysis, one); });
    tried_.push_back(trial.tried);
    return trial;
  }

  using Judge = std::function<void(const ProblemFile&, const Analysis&, Trial&)>;

  Trial simulate(const Refinement& setting, const Judge& judge_it) const {
    const ProblemFile divided = refined(problem_, setting);
    Trial trial;
    trial.tried = {setting, divided.simulation.step, beam_elements(divided), infinite, "", 0.0};
    try {
      const auto analysis = analyze(divided, x_);
      trial.values = values_of(*analysis);
      trial.tried.work = static_cast<double>(analysis->trajectory.steps()) *
                         analysis->model.mechanism.system->size();
      judge_it(divided, *analysis, trial);
    } catch (const SimulationError&) {  // to be tried finer
    } catch (const InputError&) {       // a window without steps
    }
    return trial;
  }

  void judge(const ProblemFile& divided, const Analysis& analysis, Trial& trial) const {
    trial.fewest_elements = fewest_elements(analysis.model, divided);
    std::vector<Refinement> refinements = {{2.0, 1.0}, {4.0, 1.0}};
    if (trial.fewest_elements) refinements.push_back({2.0, 2.0});
    const std::vector<NestedRun> runs = make_nested_runs(divided, x_, refinements);
    JudgingRuns judging;
    judging.twice_step = &runs[0];
    judging.four_steps = &runs[1];
    if (trial.fewest_elements) judging.more_elements = {&runs[2], &runs[0]};
    keep_errors(analysis, judging, trial);
  }

  void keep_errors(const Analysis& analysis, const JudgingRuns& judging, Trial& trial) const {
    trial.tried.error = trial.by_step = trial.by_elements = 0.0;
    for (const std::size_t i : asked_) {
      const ErrorBar bar = error_bar(analysis, i, judging, scheme_order(problem_.simulation));
      const double value = analysis.reductions[i].value;
      const Eigen::MatrixXd& history = analysis.histories[i];
      const double size = history.size() > 0 ? history.cwiseAbs().maxCoeff() : std::abs(value);
      const auto relative = [&](bool is_resolved, double bound) {
        return is_resolved ? value_error(value + bound, value, size) : infinite;
      };
      trial.by_step = std::max(trial.by_step, relative(bar.step.is_resolved, bar.step.bound));
      trial.by_elements =
          std::max(trial.by_elements, relative(bar.elements.is_resolved, bar.elements.bound));
      const double error = relative(bar.is_resolved(), bar.bound());
      if (error > trial.tried.error || trial.tried.response.empty()) {
        trial.tried.error = error;
        trial.tried.response = problem_.responses[i].name;
      }
    }
  }

  /// Relative, the largest of what is asked for.
  double distance_to_finer(const Trial& trial) const {
    const Refinement finer{std::min(0.25 * trial.setting().step, 1.0), trial.setting().elements};
    const NestedRun run = make_nested_run(problem_, x_, finer);
    return run.has_failed() ? infinite : distance(run.values, trial);
  }

  /// Relative to the trial, the largest of what is asked for.
  double distance(const Eigen::VectorXd& values, const Trial& trial) const {
    if (values.size() == 0) return infinite;
    double largest = 0.0;
    for (const std::size_t i : asked_) {
      const auto index = static_cast<Eigen::Index>(i);
      largest = std::max(largest, value_error(values(index), trial.values(index), 0.0));
    }
    return largest;
  }

  const ProblemFile& problem_;
  const Eigen::VectorXd& x_;
  double target_;
  std::vector<std::size_t> asked_;
  std::vector<TriedSetting> tried_;
};

}  // namespace

Refinement coarse_setting(const ProblemFile& problem) {
  return {std::max(1.0, number_of_steps(problem.simulation) / coarse_steps), 1.0};
}

SettingChoice choose_setting(const ProblemFile& problem, const Eigen::VectorXd& x, double target,
                             const Refinement& first) {
  return Search(problem, x, target).run(first);
}

}  // namespace pleuel
