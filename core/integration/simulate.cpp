#include "core/integration/simulate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/integration/checkpointed_loop.hpp"
#include "core/integration/newton_corrector.hpp"
#include "core/integration/period_map.hpp"
#include "core/integration/repetition.hpp"
#include "core/integration/scheme.hpp"
#include "core/integration/simulation_options.hpp"
#include "core/integration/stacked_states.hpp"
#include "core/integration/trajectory.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/start/equilibrium.hpp"

namespace pleuel {

namespace {

CheckpointPlan make_plan(const Mechanism& mechanism, const SimulationOptions& options) {
  const double n = mechanism.system->coordinates(), m = mechanism.system->multipliers();
  const bool is_stabilized = options.formulation.constraints == ConstraintForm::stabilized_index_2;
  const double extra = is_stabilized ? m : options.formulation.is_projected ? 2 * n : 0;
  const double state = 3 * n + m + extra;
  // Besides the state: w, the increment, the shift, and how a and λ changed last.
  const double more = (is_stabilized ? 4 : 3) * n + m;
  return {sizeof(double) * state, sizeof(double) * (state + more), options.memory};
}

/// All states, or nothing if they turn out not to fit into the memory.
std::optional<Trajectory> simulate_whole(TimeLoop loop, const CheckpointPlan& plan) {
  if (!plan.holds(loop.units() + 1.0)) return std::nullopt;
  loop.start(loop.units() + 1);
  for (int unit = 1; unit <= loop.units(); ++unit) {
    loop.advance(unit);
    if (!plan.holds(static_cast<double>(loop.instant() + 1))) return std::nullopt;
  }
  Trajectory trajectory = loop.end();
  trajectory.states = std::make_shared<StoredStates>(loop.window().take());
  return trajectory;
}

/// A simulation from consistent initial values, or from a given state: see simulate(). The period
/// of the options says nothing here.
/// @param start  what to set out from, as if a step had led there; null: consistent initial values
Trajectory simulate_plainly(Mechanism& mechanism, const SimulationOptions& options,
                            const InstantObserver& observer, const SchemeState* start = nullptr) {
  const CheckpointPlan plan = make_plan(mechanism, options);
  if (auto whole = simulate_whole({mechanism, options, observer, start}, plan)) {
    return std::move(*whole);
  }
  return simulate_with_checkpoints({mechanism, options, observer, start}, plan);
}

constexpr int most_simulations = 60;
/// The map is made anew where the gap shrinks by less than this.
constexpr double slow_search = 0.1;
/// A correction is halved so often at most.
constexpr int most_halvings_of_corrections = 6;
/// Gaps below the first that no longer shrink are round-off; below the second where a new map does not
/// make them shrink, either.
constexpr double gap_of_round_off = 1e-9, gap_of_stagnation = 1e-7, no_progress = 0.5;
/// Below it, 1 − M is singular.
constexpr double least_condition = 1e-13;
/// Growth of disturbances in a period that is more than round-off: motions without damping neither
/// grow nor die.
constexpr double unstable = 1.0 + 1e-5;
/// A map is that of a motion on the way, whose disturbances may grow otherwise. Its growth is taken for that of the
/// motion found where corrections with it converge as fast as this, the second of a similar motion, and
/// where so many times as much of it would not make the motion unstable.
constexpr double nearly_found = 1e-3, near_enough = 0.1, safety_of_growth = 4.0;
/// Growth below which a motion surely forgets how it began.
constexpr double forgetful = 1.0 - 1e-5;

/// Of a period: instants closer than this are one but for round-off.
constexpr double round_off_of_time = 1e-9;

/// Breaks of any period as those of the first, each as the earliest period has it.
std::vector<double> folded(const std::vector<double>& breaks, double period) {
  std::vector<std::pair<double, double>> times;  // in the first period, and as given
  for (const double time : breaks) times.push_back({std::fmod(time, period), time});
  std::ranges::sort(times);
  std::vector<std::pair<double, double>> different;
  for (const auto& time : times) {
    if (different.empty() || time.first - different.back().first > round_off_of_time * period) {
      different.push_back(time);
    } else if (time.second < different.back().second) {
      different.back() = time;
    }
  }
  std::vector<double> folded;
  for (const auto& time : different) folded.push_back(time.first);
  return folded;
}

/// The break that an instant is but for round-off, or the instant.
double snapped(double instant, const std::vector<double>& sorted_breaks, double round_off) {
  const auto next = std::ranges::lower_bound(sorted_breaks, instant - round_off);
  return next != sorted_breaks.end() && *next <= instant + round_off ? *next : instant;
}

/// One period of the simulation.
SimulationOptions options_of_period(const SimulationOptions& options) {
  SimulationOptions one = options;
  one.end_time = options.period;
  one.step = options.period / step_count(one);
  one.breaks = folded(options.breaks, options.period);
  const double end = options.period * (1.0 + 1e-9);
  if (options.instants.empty()) {
    one.instants = regular_instants(one);
  } else {
    std::erase_if(one.instants, [end](double time) { return time > end; });
  }
  return one;
}

/// All of it, with the steps of a period again and again.
SimulationOptions options_of_all(const SimulationOptions& options, const SimulationOptions& one,
                                 int periods) {
  SimulationOptions all = options;
  all.step = one.step;
  if (!options.instants.empty()) return all;
  all.instants = {0.0};
  std::vector<double> breaks = options.breaks;
  std::ranges::sort(breaks);
  for (int period = 0; period < periods; ++period) {
    for (std::size_t i = 1; i < one.instants.size(); ++i) {
      const bool is_last = i + 1 == one.instants.size();
      all.instants.push_back(is_last ? options.end_time * (period + 1) / periods
                                     : snapped(period * options.period + one.instants[i], breaks,
                                               round_off_of_time * options.period));
    }
  }
  return all;
}

/// A period from some start.
struct Attempt {
  SchemeState start;
  Trajectory trajectory;
  Eigen::VectorXd change;  ///< from the start to the end
  double gap = std::numeric_limits<double>::infinity();
};

class PeriodicSearch {
 public:
  PeriodicSearch(Mechanism& mechanism, const SimulationOptions& one)
      : mechanism_(mechanism), one_(one), states_(mechanism, one.instants[1] - one.instants[0]) {}

  Attempt run() {
    Attempt attempt;
    // A motion that starts from rest may make fewer turns in its first period: that alone is no
    // fault, but the likely cause of what fails later.
    try {
      attempt = search();
    } catch (const SimulationError&) {
      if (!complaint_.empty()) throw SimulationError(complaint_ + advice_);
      throw;
    }
    if (is_known()) return attempt;
    complaint_ = complaint_about_repetition(mechanism_, attempt.trajectory, one_.period);
    if (!complaint_.empty()) throw SimulationError(complaint_ + advice_);
    return attempt;
  }

  PeriodicStart found(const Attempt& attempt) {
    const bool is_of_similar = is_known() && map_ == one_.similar->periodic->map;
    double growth = is_of_similar ? one_.similar->periodic->growth : map_->growth();
    const bool is_near = contraction_ <= (is_of_similar ? near_enough : nearly_found);
    if (!is_near || growth + safety_of_growth * contraction_ > unstable) {
      make_map(attempt.trajectory);
      growth = map_->growth();
    }
    if (growth > unstable) {
      throw UnstableEquilibrium(
          fmt::format("/simulation/initial_state: the motion that repeats itself after {:.6g} s is "
                      "unstable: disturbances grow by {:.2g} % in each period, so that no machine "
                      "would run so",
                      one_.period, 100.0 * (growth - 1.0)));
    }
    return {one_.period,  attempt.trajectory.steps(), map_,
            simulations_, differentiations_,          attempt.gap,
            growth};
  }

 private:
  /// Whether a similar motion repeats itself, and is stable.
  bool is_known() const { return one_.similar && one_.similar->periodic; }

  Attempt search() {
    Attempt attempt = beside_similar();
    double rate = map_ ? 0.0 : 1.0;
    if (!map_) attempt = first_attempt();
    while (attempt.gap > one_.newton_tolerance) {
      const bool is_fresh = rate > slow_search, is_small = attempt.gap <= gap_of_round_off;
      if (is_fresh && !is_small) make_map(attempt.trajectory);
      Attempt next = corrected(attempt, is_fresh && !is_small ? most_halvings_of_corrections : 0);
      rate = next.gap / attempt.gap;
      if (next.gap > gap_of_round_off) contraction_ = std::max(contraction_, rate);
      if (rate < 1.0) attempt = std::move(next);
      const bool is_stagnant = is_fresh && attempt.gap <= gap_of_stagnation;
      if (rate > no_progress && (is_small || is_stagnant)) break;
      if ((rate >= 1.0 && is_fresh) || simulations_ > most_simulations) fail(attempt);
    }
    if (!map_) make_map(attempt.trajectory);
    return attempt;
  }

  /// From where a similar motion begins, whose map will do; without a map if there is none.
  Attempt beside_similar() {
    const Trajectory* similar = one_.similar;
    if (!is_known() || similar->recomputed()) return {};
    const auto& map = similar->periodic->map;
    if (map->states().units().size() != states_.units().size()) return {};
    try {
      Attempt attempt = simulated(end_of(*similar));
      map_ = map;
      return attempt;
    } catch (const SimulationError&) {
      return {};
    }
  }

  /// From where a period leads that begins as the file says: what it damps is gone.
  Attempt first_attempt() {
    ++simulations_;
    const Trajectory transient = simulate_plainly(mechanism_, one_, {});
    if (!is_known()) complaint_ = complaint_about_repetition(mechanism_, transient, one_.period);
    advice_ = advice_to_be_exact(mechanism_, transient);
    return simulated(end_of(transient));
  }

  /// The state at the end, as one of the beginning.
  SchemeState end_of(const Trajectory& trajectory) const {
    SchemeState end;
    trajectory.states->load(trajectory.steps(), end);
    end.q -= whole_turns(mechanism_.angles, trajectory.state_at(0).q, end.q);
    end.w = trajectory.end_w;
    end.time = 0.0;
    return end;
  }

  Attempt simulated(SchemeState start) {
    ++simulations_;
    Attempt attempt{std::move(start), {}, {}};
    attempt.trajectory = simulate_plainly(mechanism_, one_, {}, &attempt.start);
    const SchemeState end = end_of(attempt.trajectory);
    attempt.change = states_.change(attempt.start, end);
    attempt.gap = attempt.change.lpNorm<Eigen::Infinity>();
    set_multipliers(end.lambda, attempt);
    return attempt;
  }

  /// Those of the start, which no step goes on from.
  void set_multipliers(const Eigen::VectorXd& lambda, Attempt& attempt) {
    attempt.start.lambda = lambda;
    if (attempt.trajectory.recomputed()) return;
    attempt.trajectory.columns().lambda().col(0) = lambda;
  }

  /// By Newton's method, with less than its correction where that leads away.
  Attempt corrected(const Attempt& attempt, int halvings) {
    if (!map_) make_map(attempt.trajectory);
    // The map of a similar motion counts in other steps.
    const Eigen::VectorXd ratio = states_.units().cwiseQuotient(map_->states().units());
    const Eigen::VectorXd correction =
        map_->solve(ratio.cwiseProduct(attempt.change)).cwiseQuotient(ratio);
    Attempt next;
    for (int i = 0; i <= halvings; ++i) {
      try {
        next = simulated(states_.moved(attempt.start, std::ldexp(1.0, -i) * correction));
      } catch (const SimulationError&) {
        continue;  // too far away to be simulated
      }
      if (next.gap < attempt.gap) break;
    }
    return next;
  }

  void make_map(const Trajectory& trajectory) {
    ++differentiations_;
    map_ = std::make_shared<PeriodMap>(mechanism_, trajectory, trajectory.steps());
    contraction_ = 0.0;
    if (map_->reciprocal_condition() >= least_condition) return;
    if (map_->growth() < forgetful) {
      throw SimulationError(fmt::format(
          "/simulation/initial_state: the motion that repeats itself after {:.6g} s drowns in the "
          "round-off of {} steps: take a larger /simulation/step, fewer elements or modes",
          one_.period, trajectory.steps()));
    }
    throw SimulationError(fmt::format(
        "/simulation/initial_state: no motion that repeats itself after {:.6g} s can be found: "
        "after a period nothing has brought back a motion{} "
        "that was given a push. Where a motion is free, a spring, a damper or a motor has to hold "
        "it to what repeats itself; without damping no motion forgets how it began, nor does a "
        "/simulation/spectral_radius of 1 forget round-off",
        one_.period, equation_text(map_->freest_coordinate(), mechanism_.equation_names)));
  }

  [[noreturn]] void fail(const Attempt& attempt) const {
    Eigen::Index worst = 0;
    attempt.change.cwiseAbs().maxCoeff(&worst);
    throw SimulationError(fmt::format(
        "/simulation/initial_state: no motion was found that repeats itself after {:.6g} s: in {} "
        "simulated periods the closest ends off its start by {:.2g} of the scale "
        "of a coordinate{}. Look whether the mechanism has a motion of this period at all; "
        "otherwise try more damping, a smaller /simulation/step, or simulate the run-up",
        one_.period, simulations_, attempt.gap,
        equation_text(worst % mechanism_.system->coordinates(), mechanism_.equation_names)));
  }

  Mechanism& mechanism_;
  const SimulationOptions& one_;
  StackedStates states_;
  std::shared_ptr<const PeriodMap> map_;
  /// By how much the largest gap shrank least with this map: how far it is from that of the motion found.
  double contraction_ = 0.0;
  int simulations_ = 0, differentiations_ = 0;
  std::string complaint_;  ///< about what does not repeat itself
  std::string advice_;     ///< besides, from a period that begins as the file says
};

void observe(const Trajectory& trajectory, const InstantObserver& observer) {
  if (!observer) return;
  State state;
  for (int step = 0; step <= trajectory.steps(); ++step) {
    trajectory.states->load(step, state);
    observer(step, state);
  }
}

/// Steps up to a time.
int steps_until(const Trajectory& trajectory, double time) {
  int steps = 0;
  while (steps < trajectory.steps() && trajectory.time(steps) < time * (1.0 - 1e-9)) ++steps;
  return steps;
}

/// A simulation that starts from the motion that repeats itself after the period of the options, so
/// that there is no transient. With y = (q, v, a, w), all that a step of the scheme depends on, its
/// start is a zero of the change in a period, found by Newton's method (shooting: Nayfeh &
/// Balachandran 1995, ch. 5):
///     Y(y₀) − y₀ = 0,   Δy₀ = (1 − M)⁻¹ (Y(y₀) − y₀),   M = ∂Y/∂y₀  (period_map.hpp)
/// The discrete motion repeats itself, not only what it approximates; whole turns of frames in a
/// plane are left out. M is kept while it serves.
/// @throws SimulationError if something that acts does not repeat itself (repetition.hpp), if a
///         motion is free, unstable, or none is found
Trajectory simulate_periodic(Mechanism& mechanism, const SimulationOptions& options,
                             const InstantObserver& observer) {
  const SimulationOptions one = options_of_period(options);
  PeriodicSearch search(mechanism, one);
  Attempt attempt = search.run();
  PeriodicStart found = search.found(attempt);
  const int periods = static_cast<int>(std::lround(options.end_time / options.period));
  Trajectory& trajectory = attempt.trajectory;
  if (periods > 1 || trajectory.recomputed()) {
    trajectory = simulate_plainly(mechanism, options_of_all(options, one, periods), observer,
                                  &attempt.start);
  } else {
    observe(trajectory, observer);
  }
  found.steps = steps_until(trajectory, options.period);
  trajectory.periodic = std::make_shared<PeriodicStart>(std::move(found));
  return std::move(trajectory);
}

}  // namespace

Trajectory simulate(Mechanism& mechanism, const SimulationOptions& options,
                    const InstantObserver& observer) {
  if (options.period > 0.0) return simulate_periodic(mechanism, options, observer);
  return simulate_plainly(mechanism, options, observer);
}

}  // namespace pleuel
