#include "core/trust/critical_instants.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "core/linear/elastic_stability.hpp"
#include "core/linear/linearization.hpp"
#include "core/model/state_in_space.hpp"
#include "core/response/full_mechanism.hpp"
#include "core/response/lateral_buckling_signal.hpp"
#include "core/system/term.hpp"

namespace pleuel {

namespace {

/// Of the Euler load of two pins at the ends of a column as long as all elastic beams together.
constexpr double harmless_press = 0.05;
/// A free end takes a quarter of the load of two pins.
constexpr double of_free_end = 4.0;
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
  double falls = 0.0;               ///< by how much the share falls in the motion, pulls included

  PressedBeam(const std::string& name, const Model& model)
      : member(name, model, BendingPlane::xy), euler(euler_load(member)) {}

  void see(const State& state) {
    const double share = -member.observe(state).topRows<2>().minCoeff() / euler;
    if (!shares.empty()) falls += std::max(0.0, last_ - share);
    last_ = share;
    shares.push_back(std::max(0.0, share));
  }

 private:
  double last_ = 0.0;
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

  /// What the stiffness gains in the motion while at most such a share of it is taken: of a beam no more than
  /// that share is, or than of a column as long as all beams together with a free end.
  double gain(double most) const {
    double sum = 0.0;
    for (const PressedBeam& beam : beams_) {
      const double longer = length_ / beam.member.full_length();
      const double of_press = most / std::max(std::ranges::max(beam.shares), 1e-300);
      sum += beam.falls * std::min(of_press, of_free_end * longer * longer);
    }
    return sum;
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

/// The largest of some values, and when it was.
struct Largest {
  double value = 0.0;
  int when = -1;

  void see(double other, int instant) {
    constexpr double more = 1.0 + 1e-6;  // of values that are alike the first
    if (other <= more * value) return;
    value = other;
    when = instant;
  }
};

/// When joints and drives bear most, and when springs and loads push most.
class LargestForces {
 public:
  explicit LargestForces(const Mechanism& mechanism) : mechanism_(mechanism) {}

  void see(const State& state, int instant) {
    Eigen::VectorXd pushed = Eigen::VectorXd::Zero(mechanism_.system->size());
    for (const std::vector<Term*>* terms : {&mechanism_.loads, &mechanism_.springs}) {
      for (Term* term : *terms) term->add_residual(state, ConstraintLevel::position, pushed);
    }
    pushed_.see(pushed.norm(), instant);
    borne_.see(state.lambda.norm(), instant);
  }

  void add_to(std::set<int>& instants) const {
    for (const Largest& one : {borne_, pushed_}) {
      if (one.when >= 0) instants.insert(one.when);
    }
  }

 private:
  const Mechanism& mechanism_;
  Largest borne_, pushed_;
};

/// The largest share at which  ½ ∫ max(−ṡ, 0)/(1 − s) dt  leaves disturbances below harmful growth, as
/// their elastic energy is at most 1/(1 − s) of that with loads.
/// @param slowed  by how much the square of the fastest turn falls, of its largest
double harmless_share_of(const PressedBeams& beams, double slowed) {
  constexpr double most = 0.5, less = 0.02;
  for (double share = most; share > harmless_share; share -= less) {
    const double exponent = 0.5 * (beams.gain(share) + share * slowed) / (1.0 - share);
    if (exponent < std::log(harmful_growth * std::sqrt(1.0 - share))) return share;
  }
  return harmless_share;
}

}  // namespace

CriticalInstants critical_instants(const Scene& scene, const Analysis& analysis) {
  const Mechanism& mechanism = analysis.model.mechanism;
  if (mechanism.elastic.empty() && mechanism.springs.empty()) return {};
  const bool is_any_imported = std::ranges::any_of(
      analysis.model.bodies, [](const BodyModel& body) { return body.is_imported(); });
  const bool is_of_beams = mechanism.springs.empty() && !is_any_imported;
  PressedBeams beams(scene, analysis.model);
  LargestForces forces(mechanism);
  Largest turn;
  double last = 0.0, falls = 0.0;
  for (int i = 0; i < int_size(analysis.trajectory.time); ++i) {
    const State state = analysis.trajectory.state_at(i);
    beams.see(state);
    if (!is_of_beams) forces.see(state, i);
    const double speed = fastest_turn(mechanism, state).omega.norm();
    falls += std::max(0.0, last * last - speed * speed);
    last = speed;
    turn.see(speed, i);
  }
  CriticalInstants found{beams.instants(), beams.may_buckle(), harmless_share};
  forces.add_to(found.all);
  if (turn.when < 0) return found;
  found.all.insert(turn.when);
  if (!is_of_beams || !mechanism.loads.empty()) return found;
  if (is_rotor(mechanism, analysis.trajectory.state_at(turn.when))) return found;
  found.harmless = harmless_share_of(beams, falls / (turn.value * turn.value));
  return found;
}

namespace {

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

}  // namespace

bool is_held(const Body& body) {
  const auto* beam = std::get_if<BeamBody>(&body.shape);
  return beam != nullptr && beam->held;
}

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

bool is_firm_in_space(const ProblemFile& space, const TrustedRun& run,
                      const CriticalInstants& instants) {
  const Eigen::VectorXd start_values = start_design(space);
  const Design<double> start(start_values.begin(), start_values.end());
  const Design<double> design(run.x.begin(), run.x.end());
  try {
    Model model = build_model(space.scene, space.effects, start, design, std::nullopt);
    return std::ranges::none_of(instants.all, [&](int instant) {
      const State state = run.analysis.trajectory.state_at(instant);
      const std::optional<State> here = state_in_space(run.analysis.model, state, model);
      return !here || may_grow(model.mechanism, *here, instants.harmless);
    });
  } catch (const SimulationError&) {  // the run in space says why
  } catch (const InputError&) {
  }
  return false;
}

}  // namespace pleuel
