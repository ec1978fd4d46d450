#include "core/trust/setting_choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
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

/// Shares of the target that estimates for a new step and new elements aim at. Both change by powers
/// of two, so that each run serves as the coarser or finer one of others.
constexpr double step_aim = 0.4, elements_aim = 0.25;
/// What half the step may leave of a difference that shows no order, if it has one behind that.
constexpr double left_by_half = 0.25;
constexpr double most_halvings = 3.0, most_doublings = 2.0;
/// Elements are compared at four times the step where that changes what is asked by no more than this:
/// their differences change by such a share, too.
constexpr double nearly_same_values = 0.02;
/// On the way back steps grow by at most so much. Between the largest that goes by factors of two and
/// the next, one more is tried, by this less than a power law says.
constexpr double most_growth = 8.0, caution = 0.97, least_step_growth = 1.1;
/// Of the target: what comparisons may find of a setting on the way back. Bars by coarser runs,
/// which judge it later, are wider.
constexpr double share_of_bars = 0.35;
/// Of steps that are doubted for another reason than errors. Where these do not help, as of undamped
/// vibrations after jumps, more would not.
constexpr int most_halvings_of_doubted = 3;
/// A third of what is serious (resolution.hpp): the designs of an optimization differ from this.
constexpr double most_missing_energy = 0.03;

/// Of the target, for effects that are left out.
constexpr double effects_share = 0.2;

double number_of_steps(const SimulationSettings& settings) {
  return steps_within(settings.end_time, settings.step);
}

/// Of an error, relative, the largest of what is asked for; infinite: not resolved.
struct Share {
  double estimate = infinite, bound = infinite;
};

/// A setting that was tried, with what the next one follows from.
struct Trial {
  TriedSetting tried;
  Share by_step, by_elements;
  double by_others = infinite;  ///< bound: modes and Newton's tolerance, which are not chosen here
  Eigen::VectorXd values;       ///< of the responses; empty: not simulated
  Eigen::VectorXd magnitudes;   ///< what errors of them are small beside
  std::vector<std::optional<ErrorBar>> bars;  ///< of what is asked for
  bool is_order_seen = false;                 ///< in the step, of all that is asked for

  const Refinement& setting() const { return tried.setting; }
};

class Search {
 public:
  Search(const ProblemFile& problem, const Eigen::VectorXd& x, double target, JudgedBy judged_by)
      : problem_(problem),
        x_(x),
        target_(target),
        coarse_target_(judged_by == JudgedBy::this_choice ? target : share_of_bars * target),
        asked_(asked_responses(problem)),
        store_(problem, x) {}

  SettingChoice run(const Refinement& first) {
    Trial best = refine(first);
    if (is_met(best)) best = coarsened(std::move(best));
    if (is_met(best)) best = with_trusted_steps(std::move(best));
    SettingChoice choice;
    choice.is_met = is_met(best);
    choice.is_out_of_reach = std::isfinite(best.by_step.bound) && best.by_others > target_;
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
      if (i == 0 || trial.tried.error <= best.tried.error) best = trial;
      if (is_met(trial) || (std::isfinite(trial.by_step.bound) && trial.by_others > target_)) break;
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
    if (from.by_elements.bound > from.by_step.bound) {
      while (by_elements > std::max(room, 1.0)) by_elements *= 0.5;
      while (by_step > std::max(room / by_elements, 1.0)) by_step *= 0.5;
    } else {
      while (by_step > std::max(room, 1.0)) by_step *= 0.5;
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
    const double by_step = trial.by_step.estimate / target_,
                 by_elements = trial.by_elements.estimate / target_;
    Refinement next = trial.setting();
    if (!std::isfinite(by_step) || !std::isfinite(by_elements)) {
      next.step *= 0.5;
      return next;  // what elements change is known once steps are resolved
    }
    // Both at once only where each by itself misses the target.
    const bool is_step_larger = trial.by_step.bound > trial.by_elements.bound;
    if (by_step > step_aim && (is_step_larger || trial.by_step.bound > target_)) {
      next.step *= std::exp2(-times_two(by_step / step_aim, most_halvings));
    }
    if (by_elements > elements_aim && (!is_step_larger || trial.by_elements.bound > target_)) {
      next.elements *= std::exp2(times_two(by_elements / elements_aim, most_doublings));
    }
    if (next != trial.setting()) return next;
    // What is estimated would do, but is not known well enough.
    (is_step_larger ? next.step *= 0.5 : next.elements *= 2.0);
    return next;
  }

  /// How often, by order two, rather too few: what is between costs less than what is beyond.
  static double times_two(double error, double most) {
    return std::clamp(std::floor(0.5 * std::log2(error)), 1.0, most);
  }

  /// Back to fewer elements, which saves most, and to larger steps, as long as the values are those
  /// of a setting that does. The last halving of elements may not be worth the smaller steps that
  /// it leaves room for.
  Trial coarsened(const Trial& fine) {
    Trial fewest = fine, before = fine;
    while (fewest_in(fewest.setting()) >= 2) {
      Trial fewer = beside({fewest.setting().step, 0.5 * fewest.setting().elements}, fewest,
                           &ErrorBar::elements);
      if (!is_close(fewer)) break;
      before = std::exchange(fewest, std::move(fewer));
    }
    Trial best = with_larger_step(fewest);
    if (before.setting().elements > fewest.setting().elements) {
      Trial other = with_larger_step(before, 2.0 * best.setting().step / before.setting().step);
      if (other.tried.work < best.tried.work) best = std::move(other);
    }
    return best;
  }

  bool is_close(const Trial& trial) const { return trial.tried.error <= coarse_target_; }

  /// @param first  the growth to begin with; 1: none
  Trial with_larger_step(const Trial& fine, double first = 1.0) {
    Trial best = fine;
    const auto larger = [&](double growth) {
      return beside({growth * best.setting().step, best.setting().elements}, fine, &ErrorBar::step);
    };
    if (first > 1.0) {
      if (most_growth_of(best, fine) < first) return fine;
      best = larger(first);
      if (!is_close(best)) return fine;
    }
    while (true) {
      const double growth = std::min(most_growth_of(best, fine), 2.0);
      if (growth < least_step_growth) return best;
      Trial next = larger(growth);
      if (!is_close(next)) {
        const double between = std::pow(growth, share_that_does(best, next)) * caution;
        if (between < least_step_growth) return best;
        next = larger(between);
        return is_close(next) ? next : best;
      }
      best = std::move(next);
    }
  }

  double most_growth_of(const Trial& from, const Trial& fine) const {
    const double most_seen = std::max(number_of_steps(problem_.simulation) / fewest_steps, 1.0);
    return std::min(most_growth * fine.setting().step, most_seen) / from.setting().step;
  }

  /// Of the way, in the logarithm of the step, from a setting that does to one that does not: up to the
  /// target of comparisons, if errors follow a power of the step.
  double share_that_does(const Trial& close, const Trial& far) const {
    const double from = close.tried.error, to = far.tried.error;
    if (!(from > 0.0 && from < coarse_target_ && std::isfinite(to))) return 0.0;
    return std::log(coarse_target_ / from) / std::log(to / from);
  }

  /// Smaller steps where something else than the errors speaks against them: nothing that rests on
  /// such steps would be verified.
  Trial with_trusted_steps(Trial best) {
    Trial finer = best;
    for (int i = 0; i < most_halvings_of_doubted && are_steps_doubted(finer.setting()); ++i) {
      if (room_beyond(finer) < 2.0) break;
      finer = measure(finer.setting() * Refinement{0.5});
      if (finer.values.size() == 0) break;
      if (is_met(finer)) best = finer;
    }
    return best;
  }

  bool are_steps_doubted(const Refinement& setting) {
    const NestedRun& nested = with_states(setting);
    const Monitors monitors = monitor(nested.analysis->model, nested.analysis->trajectory);
    const TrustedRun run{nested.problem, x_, *nested.analysis, monitors};
    return monitors.energy_error > most_missing_energy ||
           has_serious(check_laws_over_coordinates(run)) || has_serious(check_fast_turning(run));
  }

  /// A coarser setting, with the errors of the finer one and what differs.
  Trial beside(const Refinement& setting, const Trial& fine, ErrorPart ErrorBar::*cause) {
    Trial trial = fine;
    trial.tried = untried(setting);
    if (!store_.has(setting)) with_states(setting);
    const RefinedRun& run = store_.run(setting);
    if (!run.has_failed()) {
      take(run, trial);
      for (const std::size_t i : asked_) {
        ErrorPart& part = (*trial.bars[i]).*cause;
        const double known = part.bound - std::abs(part.change);
        part.change += fine.values(i) - trial.values(i);
        part.bound = std::abs(part.change) + known;
      }
      rate(trial);
    }
    tried_.push_back(trial.tried);
    return trial;
  }

  Trial measure(const Refinement& setting) {
    std::erase_if(nested_, [&](const auto& entry) { return entry.first != setting; });
    Trial trial;
    trial.tried = untried(setting);
    if (can_be_simulated(setting)) {
      const NestedRun& run = with_states(setting);
      if (run.analysis) {
        take(store_.run(setting), trial);
        judge(run.problem, *run.analysis, trial);
      }
    }
    tried_.push_back(trial.tried);
    return trial;
  }

  /// Else it is to be tried finer.
  bool can_be_simulated(const Refinement& setting) const {
    try {
      return check_before(starting_at(refined(problem_, setting), x_)).empty();
    } catch (const SimulationError&) {
    } catch (const InputError&) {
    }
    return false;
  }

  const NestedRun& with_states(const Refinement& setting) {
    const auto [entry, is_new] = nested_.try_emplace(setting);
    if (is_new) {
      entry->second = simulate_refined(problem_, x_, setting);
      store_.keep(setting, refined_run_of(entry->second));
    }
    return entry->second;
  }

  TriedSetting untried(const Refinement& setting) const {
    const ProblemFile divided = refined(problem_, setting);
    return {setting, divided.simulation.step, beam_elements(divided), infinite, "", 0.0};
  }

  static void take(const RefinedRun& run, Trial& trial) {
    trial.values = run.values;
    trial.tried.work = run.work;
  }

  /// Of the segments of elastic beams.
  double fewest_in(const Refinement& setting) const {
    return std::ceil(setting.elements * fewest_of_file_);
  }

  void judge(const ProblemFile& divided, const Analysis& analysis, Trial& trial) {
    const Refinement& at = trial.setting();
    fewest_of_file_ = fewest_elements(analysis.model, problem_).value_or(0);
    const RefinedRun& four = store_.run(at * Refinement{4.0});
    trial.magnitudes = trial.values.cwiseAbs();
    const bool is_four_enough =
        !four.has_failed() && std::ranges::all_of(asked_, [&](std::size_t i) {
          return value_error(four.values(i), trial.values(i), trial.magnitudes(i)) <=
                 nearly_same_values;
        });
    RefinementSet set(store_, at, divided, analysis, Divisions::both, is_four_enough ? 4.0 : 2.0);
    keep_errors(analysis, set.runs(), trial);
    if (!may_be_met(trial) || (is_met(trial) && trial.is_order_seen)) return;
    with_states(at * Refinement{0.5});
    set.refine_steps();
    keep_errors(analysis, set.runs(), trial);
    if (set.runs().half_step->has_failed()) trial.tried.error = infinite;
  }

  /// Whether half the step may show it.
  bool may_be_met(const Trial& trial) const {
    const double left = trial.is_order_seen ? 1.0 : left_by_half;
    const double seen = safety::of_seen * left * trial.by_step.estimate;
    return is_met(trial) || seen + trial.by_elements.bound + trial.by_others <= target_;
  }

  void keep_errors(const Analysis& analysis, const JudgingRuns& judging, Trial& trial) const {
    trial.magnitudes = trial.values.cwiseAbs();
    trial.bars.resize(problem_.responses.size());
    trial.by_step = trial.by_elements = {0.0, 0.0};
    trial.by_others = 0.0;
    trial.is_order_seen = true;
    const int order = scheme_order(problem_.simulation);
    for (const std::size_t i : asked_) {
      Evidence evidence = evidence_of(analysis, i, judging, order);
      evidence.element_order = element_order(problem_, i);
      trial.magnitudes(i) = evidence.magnitude;
      trial.bars[i] = error_bar(evidence);
      const ErrorPart elements = element_part(evidence);
      ErrorPart others = trial.bars[i]->newton;
      if (elements.is_resolved) {  // else nothing is known of modes
        others.bound += trial.bars[i]->elements.bound - elements.bound;
        others.is_resolved = others.is_resolved && trial.bars[i]->elements.is_resolved;
      }
      trial.is_order_seen = trial.is_order_seen && (trial.bars[i]->step.bound == 0.0 ||
                                                    is_near_order(trial.bars[i]->order, order));
      widen(trial.by_step, trial, i, trial.bars[i]->step);
      widen(trial.by_elements, trial, i, elements);
      trial.by_others = std::max(trial.by_others, relative(trial, i, others, others.bound));
    }
    rate(trial);
  }

  static void widen(Share& share, const Trial& trial, std::size_t response, const ErrorPart& part) {
    const double change = part.change == 0.0 ? part.bound : part.change;
    share.estimate = std::max(share.estimate, relative(trial, response, part, change));
    share.bound = std::max(share.bound, relative(trial, response, part, part.bound));
  }

  /// Infinite where the part is not resolved.
  static double relative(const Trial& trial, std::size_t response, const ErrorPart& part,
                         double error_of_part) {
    const double value = trial.values(response);
    const double error = value_error(value + error_of_part, value, trial.magnitudes(response));
    return part.is_resolved && std::isfinite(error) ? error : infinite;
  }

  /// The largest error of what is asked for, by the bars.
  void rate(Trial& trial) const {
    trial.tried.error = 0.0;
    for (const std::size_t i : asked_) {
      const ErrorBar& bar = *trial.bars[i];
      const double error =
          relative(trial, i, {bar.change(), bar.bound(), bar.is_resolved()}, bar.bound());
      if (error > trial.tried.error || trial.tried.response.empty()) {
        trial.tried.error = error;
        trial.tried.response = problem_.responses[i].name;
      }
    }
  }

  const ProblemFile& problem_;
  const Eigen::VectorXd& x_;
  double target_, coarse_target_;
  std::vector<std::size_t> asked_;
  RefinedRuns store_;
  std::map<Refinement, NestedRun> nested_;  ///< with states, since the last that was measured
  int fewest_of_file_ = 0;                  ///< elements of a segment of an elastic beam
  std::vector<TriedSetting> tried_;
};

/// None where no effect can be left out.
std::optional<ProblemFile> without_small_effects(ProblemFile problem, const Eigen::VectorXd& x,
                                                 double tolerance) {
  problem.effects.tolerance = tolerance;
  try_to_leave_out(problem, x);
  const auto& measured = problem.effects.decisions.measured;
  const bool leaves_out =
      std::ranges::any_of(measured, [](const auto& entry) { return !entry.second.is_needed; });
  return leaves_out ? std::optional(std::move(problem)) : std::nullopt;
}

}  // namespace

Refinement coarse_setting(const ProblemFile& problem) {
  const double factor = number_of_steps(problem.simulation) / coarse_steps;
  return {std::exp2(std::floor(std::log2(std::max(factor, 1.0)))), 1.0};
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
