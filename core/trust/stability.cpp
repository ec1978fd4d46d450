#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/integration/trajectory.hpp"
#include "core/linear/elastic_stability.hpp"
#include "core/linear/linearization.hpp"
#include "core/linear/modes.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/response/full_mechanism.hpp"
#include "core/start/equilibrium.hpp"
#include "core/trust/check_list.hpp"
#include "core/trust/coarse_runs.hpp"
#include "core/trust/critical_instants.hpp"
#include "core/trust/disturbance_growth.hpp"
#include "core/trust/refined_runs.hpp"

namespace pleuel {

namespace {

constexpr const char* remedy = " Make it stiffer, or hold it.";

Finding not_judged(const std::string& reason) {
  return {"Whether the pressed beams of the mechanism buckle was not looked at: " + reason, false};
}

std::string times_text(double factor) {
  if (factor >= 1e6) return "a million times and more";
  return factor < 100.0 ? fmt::format("{:.2g} times", factor) : fmt::format("{:.0f} times", factor);
}

Finding grown(const DisturbanceGrowth& growth, const ElasticStability& frozen) {
  const std::string how =
      frozen.is_stable
          ? "the motion or what acts feeds it (flutter, whirl, or parametric resonance)"
          : "it " + frozen.how;
  return {fmt::format("From t = {:.4g} s to {:.4g} s a small disturbance of {} grows {}: {}. The "
                      "motion itself may not show it. Make it stiffer, damp or hold it.",
                      growth.begin, growth.largest, growth.where, times_text(growth.factor), how),
          true};
}

Finding passing(const ElasticStability& frozen, double time, const DisturbanceGrowth& growth) {
  const std::string what = growth.factor > 1.0
                               ? fmt::format("grows {} only", times_text(growth.factor))
                               : "has no time to grow";
  return {fmt::format("At t = {:.4g} s the mechanism is not in stable equilibrium with its loads: "
                      "{} {}. In this motion a small disturbance {}.",
                      time, frozen.where, frozen.how, what),
          false};
}

/// None where small motions have no modes, as without inertia.
std::optional<std::complex<double>> growing_mode_or_none(const Mechanism& mechanism,
                                                         const State& state) {
  try {
    return growing_mode(mechanism, state);
  } catch (const SimulationError&) {
    return std::nullopt;
  }
}

/// A mode that grows about a state in which nothing turns.
struct GrowingMode {
  std::complex<double> mode;
  double exponent;   ///< of its growth in the rest of a motion
  bool is_followed;  ///< whether the steps are short enough for the motion to show it
};

/// @param step  of the motion that is judged [s]
std::optional<GrowingMode> growing_mode_at(const Mechanism& mechanism, const State& state,
                                           double end, double step) {
  constexpr double standing = 1e-3, longest_step = 0.5;  // [1/s], times |s|
  if (fastest_turn(mechanism, state).omega.norm() > standing) return std::nullopt;
  const auto mode = growing_mode_or_none(mechanism, state);
  if (!mode) return std::nullopt;
  return GrowingMode{*mode, mode->real() * (end - state.time),
                     std::abs(*mode) * step <= longest_step};
}

Finding unfollowed(const GrowingMode& grows, double time, double step) {
  const std::string what =
      vibrates(grows.mode)
          ? fmt::format("a vibration of {:.4g} Hz", grows.mode.imag() / (2.0 * std::numbers::pi))
          : "a small disturbance";
  return {fmt::format("At t = {:.4g} s {} grows as exp({:.4g} t), which steps of {:.2g} s do not "
                      "follow: it {}.{}",
                      time, what, grows.mode.real(), step,
                      vibrates(grows.mode) ? "flutters" : "buckles", remedy),
          true};
}

/// The first of some instants at which disturbances may grow in the coordinates of a model.
std::optional<int> first_doubtful(const CriticalInstants& instants, const Analysis& analysis) {
  for (const int i : instants.all) {
    const State state = analysis.trajectory.state_at(i);
    if (may_grow(analysis.model.mechanism, state, instants.harmless)) return i;
  }
  return std::nullopt;
}

/// Of a mechanism whose model shows buckling.
/// @param step  of the motion that is judged, of which this may be a coarser run [s]
/// @throws SimulationError where the steps have no derivatives
std::vector<Finding> judge_motion(const Scene& scene, const Analysis& analysis, double step) {
  const CriticalInstants instants = critical_instants(scene, analysis);
  const Mechanism& mechanism = analysis.model.mechanism;
  const Trajectory& trajectory = analysis.trajectory;
  const std::optional<int> first = first_doubtful(instants, analysis);
  if (!first) return {};
  ElasticStability frozen;
  State state;
  for (const int i : instants.all) {
    trajectory.states->load(i, state);
    frozen = elastic_stability(mechanism, state);
    if (!frozen.is_stable) break;
  }
  const DisturbanceGrowth growth = disturbance_growth(mechanism, trajectory);
  if (growth.factor > harmful_growth) return {grown(growth, frozen)};
  if (frozen.is_stable) trajectory.states->load(*first, state);
  const std::optional<GrowingMode> grows =
      growing_mode_at(mechanism, state, trajectory.time(trajectory.steps()), step);
  const bool is_of_members = grows && (vibrates(grows->mode) || !frozen.is_stable);  // else rigid
  if (is_of_members && !grows->is_followed && grows->exponent > std::log(harmful_growth)) {
    return {unfollowed(*grows, state.time, step)};
  }
  const bool is_shown =
      mechanism.elastic.empty() && growth.factor <= 1.0;  // by the motion: it falls
  if (!frozen.is_stable) {
    return is_shown ? std::vector<Finding>() : std::vector{passing(frozen, state.time, growth)};
  }
  if (!grows || grows->exponent < std::numbers::ln2) return {};
  if (growth.factor <= 1.0 || std::log(growth.factor) < 0.5 * grows->exponent) return {};
  frozen.where = growth.where;
  frozen.how = "flutters";
  return {passing(frozen, state.time, growth)};
}

double step_of(const TrustedRun& run) {
  return run.analysis.trajectory.scheme.step;
}

std::vector<Finding> judge_in_space(const TrustedRun& run, const ProblemFile& space) {
  std::string failure;
  // Disturbances need no fine steps; where twice the step is too long, that of the file is not.
  for (const double step : {2.0, 1.0}) {
    const ProblemFile coarse = refined(space, {.step = step});
    try {
      const std::unique_ptr<Analysis> analysis = analyze(coarse, run.x, judging(nullptr));
      return judge_motion(space.scene, *analysis, step_of(run));
    } catch (const UnstableEquilibrium& error) {
      return {{fmt::format("In space and with geometric stiffening {}.{}", error.what(), remedy),
               true}};
    } catch (const SimulationError& error) {
      failure = error.what();
    } catch (const InputError& error) {
      failure = error.what();
    }
  }
  return {not_judged("in space and with geometric stiffening it cannot be simulated: " + failure)};
}

/// Of the motion, as it is or in space.
std::vector<Finding> judge_members(const TrustedRun& run) {
  const Analysis& analysis = run.analysis;
  if (shows_buckling(run.problem.scene, analysis.model)) {
    try {
      return judge_motion(run.problem.scene, in_twice_the_step(run), step_of(run));
    } catch (const SimulationError& error) {
      return {not_judged(error.what())};
    }
  }
  const ProblemFile space = problem_in_space(run);
  const TrustedRun coarse = in_larger_steps(run);
  for (const TrustedRun* looked_at : {&coarse, &run}) {
    const CriticalInstants instants = critical_instants(run.problem.scene, looked_at->analysis);
    if (!instants.may_buckle && !first_doubtful(instants, looked_at->analysis)) return {};
    if (is_firm_in_space(space, *looked_at, instants)) return {};
    if (&looked_at->analysis == &analysis) break;
  }
  return judge_in_space(run, space);
}

/// Of the mechanism in space.
int coordinates_in_space(const Model& model) {
  return model.mechanism.system->coordinates() + model.effects.front().coordinates_saved;
}

std::vector<std::string> numbers_of_modes(const Analysis& analysis) {
  std::vector<std::string> names;
  for (const Response& response : analysis.responses) {
    if (response.mode()) names.push_back(response.name);
  }
  return names;
}

/// Whether nothing moves, nor begins to.
bool is_in_equilibrium(const Mechanism& mechanism, const State& state) {
  constexpr double nothing = 1e-6;  // [1/s²]
  return state.v.isZero(0.0) &&
         state.a.cwiseQuotient(mechanism.scale).lpNorm<Eigen::Infinity>() <= nothing;
}

bool stays_at_rest(const Mechanism& mechanism, const Trajectory& trajectory) {
  return is_in_equilibrium(mechanism, trajectory.state_at(trajectory.steps()));
}

/// Of the start, where it is an equilibrium and the file asks for one, or for small vibrations about one, or the
/// motion never leaves it: the mode that grows fastest, rigid motions included. Where beams are held from
/// outside, it does not know.
std::vector<Finding> judge_start(const TrustedRun& run) {
  const Analysis& analysis = run.analysis;
  const std::vector<std::string> names = numbers_of_modes(analysis);
  const Model& model = names.empty() ? analysis.model : model_of_modes(analysis);
  const bool is_large = model.mechanism.system->coordinates() > most_judged_coordinates;
  if (is_large || !analysis.modes_left_out.empty()) return {};
  if (std::ranges::any_of(run.problem.scene.bodies, is_held)) return {};
  const State state =
      names.empty() ? analysis.trajectory.state_at(0) : analysis.vibrating->initial.state;
  if (!is_in_equilibrium(model.mechanism, state)) return {};
  const bool is_equilibrium = run.problem.simulation.quasi_static_start ||
                              stays_at_rest(analysis.model.mechanism, analysis.trajectory);
  if (names.empty() && !is_equilibrium) return {};
  const auto mode = growing_mode_or_none(model.mechanism, state);
  if (!mode) return {};
  const bool is_flutter = vibrates(*mode);
  const std::string rate = fmt::format("grows as exp({:.4g} t)", mode->real());
  const std::string what = is_flutter ? fmt::format("a vibration of {:.4g} Hz {} (flutter)",
                                                    mode->imag() / (2.0 * std::numbers::pi), rate)
                                      : fmt::format("a small disturbance {}", rate);
  const bool is_shown = !names.empty() && !is_flutter;
  return {
      {fmt::format("The mechanism is unstable where it starts: {}.{}", what,
                   is_shown ? " The frequency of such a mode is given as a negative number." : ""),
       is_equilibrium || is_flutter,
       is_equilibrium ? std::vector<std::string>() : names}};  // all of the motion, or its modes
}

}  // namespace

std::vector<Finding> check_stability(const TrustedRun& run) {
  const Model& model = run.analysis.model;
  std::vector<Finding> findings = judge_start(run);
  if (!findings.empty() && findings.front().is_serious) return findings;
  if (coordinates_in_space(model) <= most_judged_coordinates) {
    const std::vector<Finding> of_motion = judge_members(run);
    findings.insert(findings.end(), of_motion.begin(), of_motion.end());
  } else if (critical_instants(run.problem.scene, in_larger_steps(run).analysis).may_buckle) {
    findings.push_back(
        not_judged(fmt::format("it has more than {} coordinates.", most_judged_coordinates)));
  }
  return findings;
}

}  // namespace pleuel
