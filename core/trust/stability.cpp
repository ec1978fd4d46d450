#include "core/trust/stability.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "core/linear/elastic_stability.hpp"
#include "core/linear/modes.hpp"
#include "core/linear/turning.hpp"
#include "core/model/state_in_space.hpp"
#include "core/response/full_mechanism.hpp"
#include "core/response/lateral_buckling_signal.hpp"
#include "core/start/equilibrium.hpp"
#include "core/trust/disturbance_growth.hpp"
#include "core/trust/refined_runs.hpp"

namespace pleuel {

namespace {

/// Of the Euler load of two pins at the ends of a column as long as all elastic beams together.
constexpr double harmless_press = 0.05;
/// A disturbance that grows more makes another motion than the one that is shown.
constexpr double harmful_growth = 10.0;

/// Of two pins at the ends of the beam with its fittings, about the weakest axis of the weakest
/// element.
double euler_load(const LateralMember& member) {
  const Beam<double>& beam = member.beam();
  const double wave = std::numbers::pi / member.full_length();
  double weakest = std::numeric_limits<double>::infinity();
  for (const BeamElement<double>& element : beam.elements) {
    const auto& [y, z] = std::pair(element.section.inertia_y, element.section.inertia_z);
    weakest = std::min(weakest, element.young * std::min(y, z));
  }
  return wave * wave * weakest;
}

/// A beam, and how it is pressed.
struct PressedBeam {
  LateralMember member;
  double euler;
  std::vector<double> shares = {};  ///< of its Euler load, one an instant

  PressedBeam(const std::string& name, const Model& model)
      : member(name, model, BendingPlane::xy), euler(euler_load(member)) {}

  void see(const State& state) {
    const double press = std::max(0.0, -member.observe(state).topRows<2>().minCoeff());
    shares.push_back(press / euler);
  }
};

/// All elastic beams of a mechanism, and when they were pressed most, alone and together.
class PressedBeams {
 public:
  PressedBeams(const Scene& scene, const Model& model)
      : harmless_(model.mechanism.springs.empty() ? harmless_press : 0.0) {
    for (const Body& body : scene.bodies) {
      if (!std::holds_alternative<BeamBody>(body.shape)) continue;
      if (!model.parts(body.name).front()->is_elastic) continue;
      beams_.emplace_back(body.name, model);
      length_ += beams_.back().member.full_length();
    }
  }

  bool is_empty() const { return beams_.empty(); }

  void see(const State& state) {
    double sum = 0.0;
    for (PressedBeam& beam : beams_) {
      beam.see(state);
      sum += beam.shares.back();
    }
    sums_.push_back(sum);
  }

  /// Instants at which beams are pressed most, each of them and all together.
  std::set<int> instants() const {
    std::set<int> instants{peak(sums_)};
    for (const PressedBeam& beam : beams_) instants.insert(peak(beam.shares));
    return instants;
  }

  /// Whether one is pressed enough to buckle, in whatever it is a part of.
  bool may_buckle() const {
    return std::ranges::any_of(beams_, [&](const PressedBeam& beam) {
      const double share = beam.member.full_length() / length_;
      return beam.shares[peak(beam.shares)] > harmless_ * share * share;
    });
  }

 private:
  /// Where the largest is reached, but for little: what grows has the rest of the motion.
  static int peak(const std::vector<double>& shares) {
    constexpr double nearly = 0.999;
    const double enough = nearly * std::ranges::max(shares);
    const auto first =
        std::ranges::find_if(shares, [enough](double share) { return share >= enough; });
    return static_cast<int>(first - shares.begin());
  }

  double harmless_;  ///< with springs, which may be as soft as they like: nothing
  std::vector<PressedBeam> beams_;
  double length_ = 0.0;       ///< of all [m]
  std::vector<double> sums_;  ///< of shares of Euler loads, one an instant
};

/// Instants at which it is worth while to look: of the largest presses and of the fastest turn.
struct CriticalInstants {
  std::set<int> all;
  bool may_buckle = false;  ///< by what presses alone
};

CriticalInstants critical_instants(const Scene& scene, const Analysis& analysis) {
  PressedBeams beams(scene, analysis.model);
  if (beams.is_empty()) return {};
  double fastest = 0.0;
  int when = -1;
  State state;
  for (int i = 0; i < int_size(analysis.trajectory.time); ++i) {
    constexpr double more = 1.0 + 1e-6;
    analysis.trajectory.states->load(i, state);
    beams.see(state);
    const double speed = fastest_turn(analysis.model.mechanism, state).omega.norm();
    if (speed <= more * fastest) continue;
    fastest = speed;
    when = i;
  }
  CriticalInstants found{beams.instants(), beams.may_buckle()};
  if (when >= 0) found.all.insert(when);
  return found;
}

/// Whether the file says that something outside of the mechanism holds a body.
bool is_held(const Body& body) {
  const auto* beam = std::get_if<BeamBody>(&body.shape);
  return beam != nullptr && beam->held;
}

/// A beam of one element buckles late, at 12 EI/L² between pins, or never, between clamps; with two the
/// largest error of Euler's cases is 3 %.
constexpr int fewest_elements_to_buckle = 2;

int elements_of(const Model& model, const std::string& beam) {
  int elements = 0;
  for (const BodyModel* part : model.parts(beam)) elements += int_size(part->beam.elements);
  return elements;
}

/// Whether the mesh of a body is too coarse to buckle.
bool is_coarse(const Body& body, const Model& model) {
  return std::holds_alternative<BeamBody>(body.shape) &&
         model.parts(body.name).front()->is_elastic &&
         elements_of(model, body.name) < fewest_elements_to_buckle;
}

/// Whether bodies move in space, beams have their geometric stiffening and elements enough, and nothing is
/// held from outside.
bool shows_buckling(const Scene& scene, const Model& model) {
  const auto shows_it = [](const BodyModel& body) {
    const bool is_elastic_beam = body.is_beam() && body.is_elastic;
    return body.frame.rotation != RotationCoordinates::angle &&
           (!is_elastic_beam || body.has_stiffening);
  };
  const auto prevents_it = [&](const Body& body) {
    return is_held(body) || is_coarse(body, model);
  };
  return std::ranges::none_of(scene.bodies, prevents_it) &&
         std::ranges::all_of(model.bodies, shows_it);
}

/// A point between the ends of a beam; of ends that follow different variables, as they are at a design.
Point between(const BeamBody& beam, double share, const Design<double>& design) {
  Point point;
  for (std::size_t i = 0; i < 3; ++i) {
    const Number &from = beam.from[i], &to = beam.to[i];
    const auto mix = [share](double a, double b) { return (1.0 - share) * a + share * b; };
    point[i] = mix(resolve(from, design), resolve(to, design));
    const bool follow_one = !from.expression && !to.expression && from.variable == to.variable;
    if (!follow_one) continue;
    point[i] = from;
    point[i].constant = mix(from.constant, to.constant);
    point[i].factor = mix(from.factor, to.factor);
  }
  return point;
}

/// Joints with the ground in place of what holds beams from outside.
void add_outside_holds(const Eigen::VectorXd& x, Scene& scene) {
  const Design<double> design(x.begin(), x.end());
  for (const Body& body : scene.bodies) {
    const auto* beam = std::get_if<BeamBody>(&body.shape);
    if (beam == nullptr || !beam->held) continue;
    std::vector<double> places = beam->held->at;
    constexpr int many = 8;
    for (int i = 0; i <= many && beam->held->at.empty(); ++i) places.push_back(double(i) / many);
    for (std::size_t i = 0; i < places.size(); ++i) {
      Joint joint;
      joint.name = fmt::format("{} held {}", body.name, i);
      joint.type = JointType::point_on_plane;
      joint.bodies = {ground_name, body.name};
      joint.at = between(*beam, places[i], design);
      joint.axis = beam->held->direction;
      scene.joints.push_back(joint);
    }
  }
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

std::optional<GrowingMode> growing_mode_at(const Mechanism& mechanism, const State& state,
                                           const Trajectory& trajectory) {
  constexpr double standing = 1e-3, longest_step = 0.5;  // [1/s], times |s|
  if (fastest_turn(mechanism, state).omega.norm() > standing) return std::nullopt;
  const auto mode = growing_mode_or_none(mechanism, state);
  if (!mode) return std::nullopt;
  const double rest = trajectory.time(trajectory.steps()) - state.time;
  return GrowingMode{*mode, mode->real() * rest,
                     std::abs(*mode) * trajectory.scheme.step <= longest_step};
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
std::optional<int> first_doubtful(const std::set<int>& instants, const Analysis& analysis) {
  State state;
  for (const int i : instants) {
    analysis.trajectory.states->load(i, state);
    if (may_grow(analysis.model.mechanism, state)) return i;
  }
  return std::nullopt;
}

/// Of a mechanism whose model shows buckling.
/// @throws SimulationError where the steps have no derivatives
std::vector<Finding> judge_motion(const std::set<int>& instants, const Analysis& analysis) {
  const Mechanism& mechanism = analysis.model.mechanism;
  const Trajectory& trajectory = analysis.trajectory;
  const std::optional<int> first = first_doubtful(instants, analysis);
  if (!first) return {};
  ElasticStability frozen;
  State state;
  for (const int i : instants) {
    trajectory.states->load(i, state);
    frozen = elastic_stability(mechanism, state);
    if (!frozen.is_stable) break;
  }
  const DisturbanceGrowth growth = disturbance_growth(mechanism, trajectory);
  if (growth.factor > harmful_growth) return {grown(growth, frozen)};
  if (frozen.is_stable) trajectory.states->load(*first, state);
  const std::optional<GrowingMode> grows = growing_mode_at(mechanism, state, trajectory);
  if (grows && !grows->is_followed && grows->exponent > std::log(harmful_growth)) {
    return {unfollowed(*grows, state.time, trajectory.scheme.step)};
  }
  if (!frozen.is_stable) return {passing(frozen, state.time, growth)};
  if (!grows || grows->exponent < std::numbers::ln2) return {};
  if (growth.factor <= 1.0 || std::log(growth.factor) < 0.5 * grows->exponent) return {};
  frozen.where = growth.where;
  frozen.how = "flutters";
  return {passing(frozen, state.time, growth)};
}

/// The mechanism in space, with geometric stiffening and with elements that buckle; what holds its beams from
/// outside holds them.
ProblemFile problem_in_space(const TrustedRun& run) {
  ProblemFile space = with_all_modes(run.problem);
  space.effects.geometric_stiffening = EffectChoice::on;
  space.simulation.moves_by_bending = true;  // it was asked already
  space.responses.clear();
  space.sensitivity.memory = SensitivitySettings().memory;
  for (Body& body : space.scene.bodies) {
    if (!is_coarse(body, run.analysis.model)) continue;
    auto& beam = std::get<BeamBody>(body.shape);
    beam.pieces = std::max(beam.pieces, fewest_elements_to_buckle);
  }
  add_outside_holds(run.x, space.scene);
  return space;
}

/// Whether nothing may grow in space at these instants of a motion in the plane, which is one in space.
bool is_firm_in_space(const ProblemFile& space, const TrustedRun& run,
                      const std::set<int>& instants) {
  const Eigen::VectorXd start_values = start_design(space);
  const Design<double> start(start_values.begin(), start_values.end());
  const Design<double> design(run.x.begin(), run.x.end());
  try {
    Model model = build_model(space.scene, space.effects, start, design);
    return std::ranges::none_of(instants, [&](int instant) {
      State state;
      run.analysis.trajectory.states->load(instant, state);
      const std::optional<State> here = state_in_space(run.analysis.model, state, model);
      return !here || may_grow(model.mechanism, *here);
    });
  } catch (const SimulationError&) {  // the run in space says why
  } catch (const InputError&) {
  }
  return false;
}

/// @param instants  at which it is worth while to look
std::vector<Finding> judge_in_space(const TrustedRun& run, const std::set<int>& instants) {
  const ProblemFile space = problem_in_space(run);
  if (is_firm_in_space(space, run, instants)) return {};
  std::string failure;
  // Disturbances need no fine steps; where twice the step is too long, that of the file is not.
  for (const double step : {2.0, 1.0}) {
    const ProblemFile coarse = refined(space, {.step = step});
    try {
      const std::unique_ptr<Analysis> analysis = analyze(coarse, run.x);
      return judge_motion(critical_instants(space.scene, *analysis).all, *analysis);
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
std::vector<Finding> judge_members(const TrustedRun& run, const CriticalInstants& instants) {
  const Analysis& analysis = run.analysis;
  if (shows_buckling(run.problem.scene, analysis.model)) {
    try {
      return judge_motion(instants.all, analysis);
    } catch (const SimulationError& error) {
      return {not_judged(error.what())};
    }
  }
  if (!instants.may_buckle && !first_doubtful(instants.all, analysis)) return {};
  return judge_in_space(run, instants.all);
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
  State last;
  trajectory.states->load(trajectory.steps(), last);
  return is_in_equilibrium(mechanism, last);
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
  State state;
  analysis.trajectory.states->load(0, state);
  if (!names.empty()) state = analysis.vibrating->initial.state;
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
       is_equilibrium || is_flutter, names}};
}

}  // namespace

std::vector<Finding> check_stability(const TrustedRun& run) {
  const Model& model = run.analysis.model;
  std::vector<Finding> findings = judge_start(run);
  if (!findings.empty() && findings.front().is_serious) return findings;
  const CriticalInstants instants = critical_instants(run.problem.scene, run.analysis);
  if (coordinates_in_space(model) <= most_judged_coordinates) {
    const std::vector<Finding> of_motion = judge_members(run, instants);
    findings.insert(findings.end(), of_motion.begin(), of_motion.end());
  } else if (instants.may_buckle) {
    findings.push_back(
        not_judged(fmt::format("it has more than {} coordinates.", most_judged_coordinates)));
  }
  return findings;
}

}  // namespace pleuel
