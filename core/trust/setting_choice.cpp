#include "core/trust/setting_choice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/relative_error.hpp"
#include "core/integration/simulation_options.hpp"
#include "core/response/effect_measurement.hpp"
#include "core/trust/check_list.hpp"
#include "core/trust/checks.hpp"
#include "core/trust/error_bars.hpp"
#include "core/trust/fast_laws.hpp"
#include "core/trust/refinement_set.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

constexpr double coarse_steps = 256.0;
/// Of a motion, where the file has no fewer: runs of so few may agree on having seen nothing.
constexpr double fewest_steps = 64.0;
/// Bounds of the work of one simulation: relative to that of the file, and what is always allowed
/// [steps × unknowns], some seconds: a file that is coarse bounds nothing.
constexpr double most_relative_work = 16.0, always_allowed_work = 2e6;
constexpr int most_tries = 12;
/// A setting that has less than this more of work is the same.
constexpr double least_growth = 1.05;

/// Shares of the target that a new step and new elements aim at.
constexpr double step_aim = 0.5, elements_aim = 0.25;
/// On the way back steps grow by the first of these factors as often as it goes, then once by each
/// of the others if that goes; in all by `most_growth` at most.
constexpr std::array growths = {2.0, 1.4142135623730951, 1.189207115002721};
constexpr double most_growth = 8.0;
/// Of the target: what comparisons may find of a setting on the way back. Bars by coarser runs,
/// which judge it later, are wider.
constexpr double share_of_bars = 0.35;
/// Of steps that are doubted for another reason than errors. Where these do not help, as of undamped
/// vibrations after jumps, more would not.
constexpr int most_halvings = 3;
/// A third of what is serious (resolution.hpp): the designs of an optimization differ from this.
constexpr double most_missing_energy = 0.03;

/// Of the target, for effects that are left out.
constexpr double effects_share = 0.2;

double number_of_steps(const SimulationSettings& settings) {
  return steps_within(settings.end_time, settings.step);
}

/// A setting that was tried, with what the next one follows from.
struct Trial {
  TriedSetting tried;
  /// Parts of errors; infinite: not resolved. The last is that of modes and of Newton's tolerance,
  /// which are not chosen here.
  double by_step = infinite, by_elements = infinite, by_others = infinite;
  std::optional<int> fewest_elements;
  Eigen::VectorXd values;                     ///< of the responses; empty: not simulated
  Eigen::VectorXd magnitudes;                 ///< what errors of them are small beside
  std::vector<std::optional<ErrorBar>> bars;  ///< of what is asked for

  const Refinement& setting() const { return tried.setting; }
};

class Search {
 public:
  Search(const ProblemFile& problem, const Eigen::VectorXd& x, double target, JudgedBy judged_by)
      : problem_(problem),
        x_(x),
        target_(target),
        coarse_target_(judged_by == JudgedBy::this_choice ? target : share_of_bars * target),
        asked_(asked_responses(problem)) {}

  SettingChoice run(const Refinement& first) {
    Trial best = refine(first);
    if (is_met(best)) best = coarsened(std::move(best));
    if (is_met(best)) best = with_trusted_steps(std::move(best));
    SettingChoice choice;
    choice.is_met = is_met(best);
    choice.is_out_of_reach = std::isfinite(best.by_step) && best.by_others > target_;
    choice.chosen = best.tried;
    choice.problem = refined(problem_, best.setting());
    choice.tried = std::move(tried_);
    if (choice.is_met) choice.bars = std::move(best.bars);
    return choice;
  }

 private:
  bool is_met(const Trial& trial) const { return trial.tried.error <= target_; }

  /// From coarse to fine, up to a setting that does. Else the one with the smallest error.
  Trial refine(Refinement next) {
    Trial best;
    for (int i = 0; i < most_tries; ++i) {
      Trial trial = measure(next);
      const bool seems_met = is_met(trial);
      if (seems_met) confirm(trial);
      if (i == 0 || trial.tried.error <= best.tried.error) best = trial;
      if (is_met(trial) || (std::isfinite(trial.by_step) && trial.by_others > target_)) break;
      if (seems_met) trial.by_step = infinite;  // runs agreed by accident
      next = within_bounds(finer(trial), trial);
      if (growth(next, trial.setting()) < least_growth) break;
    }
    return best;
  }

  /// Of the work.
  static double growth(const Refinement& next, const Refinement& from) {
    return next.elements / from.elements * (from.step / next.step);
  }

  /// What of a finer setting the bounds of work leave: the larger error comes first.
  static Refinement within_bounds(const Refinement& finer, const Trial& from) {
    const double room = room_beyond(from);
    double by_elements = finer.elements / from.setting().elements,
           by_step = from.setting().step / finer.step;
    if (from.by_elements > from.by_step) {
      while (by_elements > std::max(room, 1.0)) by_elements *= 0.5;
      by_step = std::clamp(room / by_elements, 1.0, by_step);
    } else {
      by_step = std::clamp(room, 1.0, by_step);
      while (by_elements > std::max(room / by_step, 1.0)) by_elements *= 0.5;
    }
    return {from.setting().step / by_step, from.setting().elements * by_elements};
  }

  /// How much more work than a setting the bounds allow. Of one that was not simulated only what it has
  /// more than the file is known.
  static double room_beyond(const Trial& trial) {
    const double beyond_file = trial.setting().elements / trial.setting().step;
    const double work = trial.tried.work;
    if (work == 0.0) return most_relative_work / beyond_file;
    return std::max(most_relative_work / beyond_file, always_allowed_work / work);
  }

  Refinement finer(const Trial& trial) const {
    const double by_step = trial.by_step / target_, by_elements = trial.by_elements / target_;
    Refinement next = trial.setting();
    if (!std::isfinite(by_step) || !std::isfinite(by_elements)) {
      next.step *= 0.5;
      return next;  // what elements change is known once steps are resolved
    }
    if (by_step > step_aim) next.step *= std::clamp(std::sqrt(step_aim / by_step), 0.125, 0.8);
    if (by_elements > 1.0 - step_aim) {
      next.elements *= std::sqrt(by_elements / elements_aim) > 2.0 ? 4.0 : 2.0;
    }
    if (by_step <= step_aim && next.elements == trial.setting().elements) next.step *= 0.7;
    return next;
  }

  /// Back to fewer elements, which saves most, and to larger steps, as long as the values are those
  /// of a setting that does. The last halving of elements may not be worth the smaller steps that
  /// it leaves room for.
  Trial coarsened(const Trial& fine) {
    Trial fewest = fine, before = fine;
    while (fewest.fewest_elements.value_or(1) >= 2) {
      std::optional<Trial> fewer = beside({fewest.setting().step, 0.5 * fewest.setting().elements},
                                          fewest, &ErrorBar::elements);
      if (!fewer) break;
      before = std::exchange(fewest, std::move(*fewer));
    }
    Trial best = with_larger_step(fewest, growths.front());
    if (before.setting().elements > fewest.setting().elements) {
      Trial other = with_larger_step(before, 2.0 * best.setting().step / before.setting().step);
      if (other.tried.work < best.tried.work) best = std::move(other);
    }
    return best;
  }

  /// @param first  the growth to begin with
  Trial with_larger_step(const Trial& fine, double first) {
    Trial best = fine;
    const auto grow = [&](double growth) {
      const double step = growth * best.setting().step;
      if (step > most_growth * fine.setting().step) return false;
      if (step > 1.0 && number_of_steps(problem_.simulation) / step < fewest_steps) return false;
      std::optional<Trial> larger = beside({step, fine.setting().elements}, fine, &ErrorBar::step);
      if (larger) best = std::move(*larger);
      return larger.has_value();
    };
    bool goes_on = grow(first);
    if (!goes_on && first > growths.front()) return best;
    while (goes_on) goes_on = grow(growths[0]);
    grow(growths[1]);
    grow(growths[2]);
    return best;
  }

  /// Smaller steps where something else than the errors speaks against them: nothing that rests on
  /// such steps would be verified.
  Trial with_trusted_steps(Trial best) {
    for (int i = 0; i < most_halvings && are_steps_doubted(best.setting()); ++i) {
      const Refinement next{0.5 * best.setting().step, best.setting().elements};
      if (room_beyond(best) < 2.0) break;
      Trial finer = measure(next);
      if (!is_met(finer)) break;
      best = std::move(finer);
    }
    return best;
  }

  bool are_steps_doubted(const Refinement& setting) const {
    const ProblemFile divided = refined(problem_, setting);
    const auto analysis = analyze(divided, x_);
    const Monitors monitors = monitor(analysis->model, analysis->trajectory);
    const TrustedRun run{divided, x_, *analysis, monitors};
    return monitors.energy_error > most_missing_energy ||
           has_serious(check_laws_over_coordinates(run)) || has_serious(check_fast_turning(run));
  }

  /// A coarser setting, if its errors are still small: those of the finer one with what differs.
  std::optional<Trial> beside(const Refinement& setting, const Trial& fine,
                              ErrorPart ErrorBar::*cause) {
    Trial trial = simulate(setting, [](const ProblemFile&, const Analysis&, Trial&) {});
    if (trial.values.size() > 0) {
      trial.by_others = fine.by_others;
      trial.magnitudes = fine.magnitudes;
      trial.bars = fine.bars;
      for (const std::size_t i : asked_) {
        ErrorPart& part = (*trial.bars[i]).*cause;
        const double known = part.bound - std::abs(part.change);
        part.change += fine.values(i) - trial.values(i);
        part.bound = std::abs(part.change) + known;
      }
      rate(trial);
    }
    tried_.push_back(trial.tried);
    return trial.tried.error <= coarse_target_ ? std::optional(std::move(trial)) : std::nullopt;
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
      if (!check_before(starting_at(divided, x_)).empty()) return trial;
      const auto analysis = analyze(divided, x_);
      trial.values = values_of(*analysis);
      trial.fewest_elements = fewest_elements(analysis->model, divided);
      trial.tried.work = static_cast<double>(analysis->trajectory.steps()) *
                         analysis->model.mechanism.system->size();
      judge_it(divided, *analysis, trial);
    } catch (const SimulationError&) {  // to be tried finer
    } catch (const InputError&) {       // a window without steps
    }
    return trial;
  }

  void judge(const ProblemFile& divided, const Analysis& analysis, Trial& trial) const {
    keep_errors(analysis, RefinementSet(divided, x_, analysis, Divisions::both).runs(), trial);
  }

  void keep_errors(const Analysis& analysis, const JudgingRuns& judging, Trial& trial) const {
    trial.magnitudes = trial.values.cwiseAbs();
    trial.bars.resize(problem_.responses.size());
    trial.by_step = trial.by_elements = trial.by_others = 0.0;
    for (const std::size_t i : asked_) {
      const Evidence evidence =
          evidence_of(analysis, i, judging, scheme_order(problem_.simulation));
      trial.magnitudes(i) = evidence.magnitude;
      trial.bars[i] = error_bar(evidence);
      const ErrorPart elements = element_part(evidence);
      ErrorPart others = trial.bars[i]->newton;
      if (elements.is_resolved) {  // else nothing is known of modes
        others.bound += trial.bars[i]->elements.bound - elements.bound;
        others.is_resolved = others.is_resolved && trial.bars[i]->elements.is_resolved;
      }
      trial.by_step = std::max(trial.by_step, relative(trial, i, trial.bars[i]->step));
      trial.by_elements = std::max(trial.by_elements, relative(trial, i, elements));
      trial.by_others = std::max(trial.by_others, relative(trial, i, others));
    }
    rate(trial);
  }

  static double relative(const Trial& trial, std::size_t response, const ErrorPart& part) {
    const double value = trial.values(response);
    return part.is_resolved ? value_error(value + part.bound, value, trial.magnitudes(response))
                            : infinite;
  }

  /// The largest error of what is asked for, by the bars.
  void rate(Trial& trial) const {
    trial.tried.error = 0.0;
    for (const std::size_t i : asked_) {
      const ErrorBar& bar = *trial.bars[i];
      const double error = relative(trial, i, {bar.change(), bar.bound(), bar.is_resolved()});
      if (error > trial.tried.error || trial.tried.response.empty()) {
        trial.tried.error = error;
        trial.tried.response = problem_.responses[i].name;
      }
    }
  }

  /// Compares with a finer run, which makes the bars narrower where it agrees.
  void confirm(Trial& trial) const {
    const Refinement finer{std::min(0.25 * trial.setting().step, 1.0), trial.setting().elements};
    const RefinedRun run = make_refined_run(problem_, x_, finer);
    if (run.has_failed()) {
      trial.tried.error = infinite;
      return;
    }
    for (const std::size_t i : asked_) {
      ErrorPart& step = trial.bars[i]->step;
      step.change = run.values(i) - trial.values(i);
      step.bound = (1.0 + left_of(*trial.bars[i])) * std::abs(step.change);
    }
    rate(trial);
  }

  /// The error of a run with a quarter of the step over its difference from the one that it confirms.
  double left_of(const ErrorBar& bar) const {
    const int order = scheme_order(problem_.simulation);
    if (!bar.order || std::abs(*bar.order - order) > safety::order_room) return 1.0;
    return safety::of_order / (std::pow(4.0, order) - 1.0);
  }

  const ProblemFile& problem_;
  const Eigen::VectorXd& x_;
  double target_, coarse_target_;
  std::vector<std::size_t> asked_;
  std::vector<TriedSetting> tried_;
};

/// None where no effect can be left out.
std::optional<ProblemFile> without_small_effects(ProblemFile problem, const Eigen::VectorXd& x,
                                                 double tolerance) {
  problem.effects.tolerance = tolerance;
  try_to_leave_out(problem, x);
  const auto& measured = problem.effects.decisions.measured;
  const bool leaves_out = std::any_of(measured.begin(), measured.end(),
                                      [](const auto& entry) { return !entry.second.is_needed; });
  return leaves_out ? std::optional(std::move(problem)) : std::nullopt;
}

}  // namespace

Refinement coarse_setting(const ProblemFile& problem) {
  return {std::max(1.0, number_of_steps(problem.simulation) / coarse_steps), 1.0};
}

SettingChoice choose_setting_and_effects(const ProblemFile& problem, const Eigen::VectorXd& x,
                                         double target, const Refinement& first,
                                         JudgedBy judged_by) {
  const double of_effects = effects_share * target;
  if (problem.effects.tolerance > 0.0 ||
      !without_small_effects(refined(problem, first), x, of_effects)) {
    return choose_setting(problem, x, target, first, judged_by);
  }
  SettingChoice choice = choose_setting(problem, x, target - of_effects, first, judged_by);
  std::optional<ProblemFile> lean = without_small_effects(choice.problem, x, of_effects);
  if (lean) choice.problem = std::move(*lean);
  return choice;
}

SettingChoice choose_setting(const ProblemFile& problem, const Eigen::VectorXd& x, double target,
                             const Refinement& first, JudgedBy judged_by) {
  return Search(problem, x, target, judged_by).run(first);
}

}  // namespace pleuel
