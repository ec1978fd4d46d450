#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/integration/step_differentiation.hpp"
#include "core/integration/trajectory.hpp"
#include "core/linear/axial_strains.hpp"
#include "core/linear/elastic_stability.hpp"
#include "core/linear/free_deformations.hpp"
#include "core/linear/linearization.hpp"
#include "core/linear/modes.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/response/full_mechanism.hpp"
#include "core/start/equilibrium.hpp"
#include "core/trust/check_list.hpp"
#include "core/trust/coarse_runs.hpp"
#include "core/trust/critical_instants.hpp"
#include "core/trust/refined_runs.hpp"

namespace pleuel {

namespace {

/// How a small disturbance of a mechanism grows along its motion.
struct DisturbanceGrowth {
  double factor = 0.0;                ///< by which it is larger than where it began
  double begin = 0.0, largest = 0.0;  ///< when it began, and when it is largest [s]
  std::string where;                  ///< what it deforms most then: "the body \"rod\""
};

/// Of each kind: lowest in frequency, and those that loads soften most.
constexpr Eigen::Index modes_of_a_kind = 4;
/// Of a motion: stretches after which disturbances that have not grown begin anew, of each of three groups: those
/// that begin often see what comes late, those that begin once what grows slowly.
constexpr int stretches = 16;
constexpr std::array<int, 3> renewals = {1, 4, 16};
constexpr double followed_growth = 1e6;
/// What turns or moves bodies by so many times as much as it deforms them is no deformation.
constexpr double rigid_ratio = 10.0;
/// What a motion that does not go along a disturbance moves that way while it grows e-fold, of a length or a
/// radian.
constexpr double hardly = 0.01;

/// The largest growth of disturbances that deform bodies, and of those that move them against springs.
struct LargestGrowth {
  DisturbanceGrowth of_members, of_springs;

  double factor() const { return std::max(of_members.factor, of_springs.factor); }
  /// That of members, unless that of springs alone does harm.
  const DisturbanceGrowth& worst() const {
    if (of_members.factor > harmful_growth) return of_members;
    return of_springs.factor > of_members.factor ? of_springs : of_members;
  }
};

/// Disturbances of a mechanism, one a column, and how large they are.
class Disturbances {
 public:
  explicit Disturbances(const Mechanism& mechanism)
      : mechanism_(mechanism), strains_(*mechanism.system) {}

  /// New ones at a state: each displaced along a mode, without velocity.
  StateSensitivity at_rest(const State& at) {
    stiffness_ = elastic_stiffness(mechanism_, at);
    const Eigen::MatrixXd z = free_deformations(mechanism_, at);
    const int n = mechanism_.system->coordinates();
    const Eigen::MatrixXd mass = scaled_tangent(mechanism_, at, {.a = 1.0}).topRows(n);
    const Eigen::MatrixXd loaded = symmetric_part(deformation_stiffness(mechanism_, at, z)),
                          inertia = regular_mass(symmetric_part(z.transpose() * mass * z)),
                          unloaded = symmetric_part(z.transpose() * stiffness_ * z);
    Eigen::MatrixXd shapes = lowest(loaded, inertia);
    if (Cholesky(unloaded).is_positive_definite()) {
      const Eigen::MatrixXd soft = lowest(loaded, unloaded);
      Eigen::MatrixXd both(z.cols(), shapes.cols() + soft.cols());
      both << shapes, soft;
      shapes = both;
    }
    return displaced(at, z * shapes);
  }

  /// The root of the elastic energy in each, of springs, too. Where members are bent, bending stretches them
  /// (axial_strains.hpp).
  Eigen::VectorXd sizes(const State& at, const StateSensitivity& disturbance) const {
    const Eigen::SparseMatrix<double> coupling = strains_.coupling(at.q);
    const Eigen::MatrixXd x = mechanism_.scale.cwiseInverse().asDiagonal() * disturbance.q;
    const Eigen::MatrixXd forces = stiffness_ * x;
    Eigen::VectorXd energies(x.cols());
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      const Eigen::VectorXd q = disturbance.q.col(i);
      energies(i) = x.col(i).dot(forces.col(i)) + q.dot(coupling * q);
    }
    return energies.cwiseMax(0.0).cwiseSqrt();
  }

  bool is_rigid(const StateSensitivity& disturbance, Eigen::Index column) const {
    Eigen::VectorXd frames = relative(disturbance, column);
    const double deformed = Eigen::VectorXd(frames(mechanism_.elastic)).lpNorm<Eigen::Infinity>();
    frames(mechanism_.elastic).setZero();
    return frames.lpNorm<Eigen::Infinity>() > rigid_ratio * deformed;
  }

  /// Of one in coordinates relative to their scales.
  Eigen::VectorXd relative(const StateSensitivity& disturbance, Eigen::Index column) const {
    return mechanism_.scale.cwiseInverse().asDiagonal() * disturbance.q.col(column);
  }

  double energy(const Eigen::VectorXd& x) const { return x.dot(stiffness_ * x); }

  /// What one deforms most, or moves most if bodies are rigid.
  std::string owner(const StateSensitivity& disturbance, Eigen::Index column) const {
    const Eigen::VectorXd x = relative(disturbance, column);
    if (is_rigid(disturbance, column)) return owner_of(mechanism_, x);
    Eigen::VectorXd deformed = Eigen::VectorXd::Zero(x.size());
    deformed(mechanism_.elastic) = x(mechanism_.elastic);
    return owner_of(mechanism_, deformed);
  }

 private:
  static Eigen::MatrixXd lowest(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& beside) {
    const SymmetricModes modes = symmetric_modes(stiffness, beside);
    return modes.vectors.leftCols(std::min(modes_of_a_kind, modes.vectors.cols()));
  }

  /// Of unit size. Accelerations follow from the first step: those of modes that it does not resolve
  /// would be taken for much too long.
  StateSensitivity displaced(const State& at, const Eigen::MatrixXd& shapes) const {
    StateSensitivity start;
    start.q = mechanism_.scale.asDiagonal() * shapes;
    const Eigen::VectorXd size = sizes(at, start).cwiseMax(1e-300);
    start.q = start.q * size.cwiseInverse().asDiagonal();
    start.v = start.a = start.w = Eigen::MatrixXd::Zero(start.q.rows(), start.q.cols());
    start.lambda = Eigen::MatrixXd::Zero(mechanism_.system->multipliers(), start.q.cols());
    return start;
  }

  const Mechanism& mechanism_;
  AxialStrains strains_;
  Eigen::MatrixXd
      stiffness_;  ///< of coordinates relative to their scales, where the last ones began
};

/// What springs hold at a state, so that it is a member of the mechanism as an elastic body is.
class HeldBySprings {
 public:
  HeldBySprings(const Mechanism& mechanism, const State& at)
      : resistance_(resistance_of_springs(mechanism, at)),
        v_(at.v.cwiseQuotient(mechanism.scale)),
        a_(at.a.cwiseQuotient(mechanism.scale)) {
    const int n = mechanism.system->coordinates();
    mass_ = scaled_tangent(mechanism, at, {.a = 1.0}).topLeftCorner(n, n);
  }

  /// Whether most of the energy of a disturbance is that of springs, and the motion itself hardly goes that way
  /// while it grows e-fold: else, as in a pendulum with a spring, the motion shows it.
  /// @param x       relative to the scales of coordinates
  /// @param energy  of all that is elastic
  /// @param rate    of its growth [1/s]
  bool holds(const Eigen::VectorXd& x, double energy, double rate) const {
    if (x.dot(resistance_ * x) < energy / 2.0) return false;
    const Eigen::VectorXd momentum = mass_.transpose() * x;
    const double size = x.lpNorm<Eigen::Infinity>() / momentum.dot(x);
    const double way =
        std::abs(momentum.dot(v_)) / rate + std::abs(momentum.dot(a_)) / (rate * rate);
    return size * way <= hardly;
  }

 private:
  Eigen::MatrixXd resistance_, mass_;
  Eigen::VectorXd v_, a_;  ///< relative to the scales of coordinates
};

/// The groups of disturbances while they are propagated.
struct Groups {
  Eigen::Index size;          ///< of each
  std::vector<double> begun;  ///< one a column [s]

  Groups(const StateSensitivity& first, double now)
      : size(first.q.cols()),
        begun(renewals.size() * static_cast<std::size_t>(first.q.cols()), now) {}

  StateSensitivity all(const StateSensitivity& one) const {
    const auto groups = static_cast<Eigen::Index>(renewals.size());
    return {one.q.replicate(1, groups), one.v.replicate(1, groups), one.a.replicate(1, groups),
            one.w.replicate(1, groups), one.lambda.replicate(1, groups)};
  }

  /// New ones in place of those that have not grown, in the groups whose turn it is.
  void renew(int stretch, double now, const Eigen::VectorXd& sizes, const StateSensitivity& fresh,
             StateSensitivity& columns) {
    for (std::size_t group = 0; group < renewals.size(); ++group) {
      if (stretch % renewals[group] != 0) continue;
      for (Eigen::Index i = 0; i < std::min(size, fresh.q.cols()); ++i) {
        const Eigen::Index column = static_cast<Eigen::Index>(group) * size + i;
        if (sizes(column) > 1.0) continue;
        begun[static_cast<std::size_t>(column)] = now;
        for (const auto part : {&StateSensitivity::q, &StateSensitivity::v, &StateSensitivity::a,
                                &StateSensitivity::w, &StateSensitivity::lambda}) {
          (columns.*part).col(column) = (fresh.*part).col(i);
        }
      }
    }
  }
};

/// The largest growth of several disturbances: of the lowest modes of deformation at an instant, and
/// of those that the loads soften most. They begin without velocity and are propagated by the exact
/// tangents of the steps (StepDifferentiation), so that whatever feeds them is seen: loads beyond
/// buckling as long as they last, forces that follow, damping that turns, coefficients that change with the time
/// or the angle. Those that have not grown begin anew several times in the motion.
///
/// The size of a disturbance is the root of its elastic energy, of springs, too: a vibration keeps it.
/// One that mostly turns or moves bodies counts where springs hold them and the motion goes elsewhere; else it
/// is a pendulum that falls. What it grows beyond 1e6 is not followed.
LargestGrowth disturbance_growth(const Mechanism& mechanism, const Trajectory& trajectory) {
  const State at = trajectory.state_at(0);
  Disturbances disturbances(mechanism);
  const StateSensitivity first = disturbances.at_rest(at);
  Groups groups(first, at.time);
  StepDifferentiation motion(mechanism, trajectory, DerivativesOf::old_state);
  motion.begin(groups.all(first));
  const int stretch = std::max(1, trajectory.steps() / stretches);
  const DisturbanceGrowth none{0.0, at.time, at.time, ""};
  LargestGrowth growth{none, none};
  while (first.q.cols() > 0 && growth.factor() < followed_growth && motion.advance()) {
    StateSensitivity now = motion.sensitivity();
    const Eigen::VectorXd sizes = disturbances.sizes(motion.state(), now);
    std::optional<HeldBySprings> springs;
    for (Eigen::Index i = 0; i < sizes.size(); ++i) {
      const bool is_rigid = disturbances.is_rigid(now, i);
      DisturbanceGrowth& largest = is_rigid ? growth.of_springs : growth.of_members;
      if (sizes(i) <= largest.factor) continue;
      const double begun = groups.begun[static_cast<std::size_t>(i)], time = motion.state().time;
      if (is_rigid) {
        if (mechanism.springs.empty()) continue;
        if (!springs) springs.emplace(mechanism, motion.state());
        const Eigen::VectorXd x = disturbances.relative(now, i);
        const double rate = std::log(sizes(i)) / (time - begun);
        if (!springs->holds(x, disturbances.energy(x), rate)) continue;
      }
      largest = {sizes(i), begun, time, disturbances.owner(now, i)};
    }
    if (motion.step() % stretch != 0 || motion.step() == trajectory.steps()) continue;
    const State here = motion.state();
    groups.renew(motion.step() / stretch, here.time, sizes, disturbances.at_rest(here), now);
    motion.begin(std::move(now), motion.step());
  }
  return growth;
}

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
  const DisturbanceGrowth growth = disturbance_growth(mechanism, trajectory).worst();
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
      return judge_motion(run.problem.scene, analysis, step_of(run));
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
