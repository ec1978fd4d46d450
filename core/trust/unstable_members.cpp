#include "core/trust/unstable_members.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "core/response/lateral_buckling_signal.hpp"
#include "core/start/elastic_stability.hpp"
#include "core/start/equilibrium.hpp"
#include "core/start/turning.hpp"

namespace pleuel {

namespace {

/// Of the Euler load of two pins at the ends of a column as long as all elastic beams together.
constexpr double harmless_press = 0.05;

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

/// A beam, and when it was pressed most.
struct PressedBeam {
  LateralMember member;
  double euler, most = 0.0;  ///< [N]
  int instant = -1;

  PressedBeam(const std::string& name, const Model& model)
      : member(name, model, BendingPlane::xy), euler(euler_load(member)) {}

  /// @returns the press over its Euler load
  double see(const State& state, int now) {
    const double press = std::max(0.0, -member.observe(state).topRows<2>().minCoeff());
    if (press > most) {
      most = press;
      instant = now;
    }
    return press / euler;
  }
};

/// All beams of a mechanism in space or with springs, and when they were pressed most together. In a
/// plane without springs beams are judged one by one (sideways_buckling.hpp).
class PressedBeams {
 public:
  PressedBeams(const Scene& scene, const Model& model)
      : harmless_(model.mechanism.springs.empty() ? harmless_press : 0.0) {
    for (const Body& body : scene.bodies) {
      if (!std::holds_alternative<BeamBody>(body.shape)) continue;
      const BodyModel& part = *model.parts(body.name).front();
      const bool is_planar = part.frame.rotation == RotationCoordinates::angle;
      if (!part.is_elastic || (is_planar && model.mechanism.springs.empty())) continue;
      beams_.emplace_back(body.name, model);
      length_ += beams_.back().member.full_length();
      has_stiffening_ = has_stiffening_ || part.has_stiffening;
    }
  }

  void see(const State& state, int now) {
    double sum = 0.0;
    for (PressedBeam& beam : beams_) sum += beam.see(state, now);
    if (sum <= most_) return;
    most_ = sum;
    instant_ = now;
  }

  bool is_empty() const { return beams_.empty(); }
  bool has_stiffening() const { return has_stiffening_; }
  /// Instants at which beams are pressed most, each of them or all together, enough to buckle.
  std::set<int> instants() const {
    std::set<int> instants;
    for (const PressedBeam& beam : beams_) {
      const double share = beam.member.full_length() / length_;
      if (beam.most > harmless_ * share * share * beam.euler) instants.insert(beam.instant);
    }
    if (!instants.empty()) instants.insert(instant_);
    return instants;
  }

 private:
  double harmless_;  ///< with springs, which may be as soft as they like: nothing
  std::vector<PressedBeam> beams_;
  double length_ = 0.0;  ///< of all [m]
  bool has_stiffening_ = false;
  double most_ = 0.0;  ///< largest sum of presses over Euler loads
  int instant_ = -1;
};

/// When what turns as one, as a shaft with its disks, turned fastest.
struct FastestRotor {
  double speed = 0.0;
  int instant = -1;

  void see(const Mechanism& mechanism, const State& state, int now) {
    constexpr double same = 1e-6;
    const double turn = fastest_turn(mechanism, state).omega.norm();
    if (!(turn > (1.0 + same) * speed) || !is_rotor(mechanism, state)) return;
    speed = turn;
    instant = now;
  }
};

PressedBeams pressed_beams(const Scene& scene, const Analysis& analysis) {
  PressedBeams beams(scene, analysis.model);
  if (beams.is_empty()) return beams;
  State state;
  for (int i = 0; i < int_size(analysis.trajectory.time); ++i) {
    analysis.trajectory.states->load(i, state);
    beams.see(state, i);
  }
  return beams;
}

constexpr const char* unseen =
    ". In the motion a member that is exactly straight stays so. Make it stiffer, or hold it.";

Doubt not_judged(const std::string& reason) {
  return {"Whether the pressed beams of the mechanism buckle was not looked at: " + reason, false};
}

/// Of a mechanism in space without geometric stiffening, which is simulated once more with it.
std::vector<Doubt> doubt_with_stiffening(const TrustedRun& run) {
  ProblemFile stiffened = run.problem;
  stiffened.effects.geometric_stiffening = EffectChoice::on;
  stiffened.responses.clear();
  try {
    const std::unique_ptr<Analysis> analysis = analyze(stiffened, run.x);
    const auto found = find_instability(stiffened.scene, *analysis);
    if (!found) return {};
    return {{"With geometric stiffening, which is off: " + found->text + unseen, true}};
  } catch (const UnstableEquilibrium& error) {
    return {
        {fmt::format("With geometric stiffening, which is off, {}. Make it stiffer, or hold it.",
                     error.what()),
         true}};
  } catch (const SimulationError& error) {
    return {
        not_judged(fmt::format("with geometric stiffening, which is off, it cannot be "
                               "simulated: {}",
                               error.what()))};
  } catch (const InputError& error) {
    return {
        not_judged(fmt::format("with geometric stiffening, which is off, it cannot be "
                               "simulated: {}",
                               error.what()))};
  }
}

}  // namespace

std::optional<Instability> find_instability(const Scene& scene, const Analysis& analysis,
                                            const std::function<int(double)>& known) {
  const Mechanism& mechanism = analysis.model.mechanism;
  if (mechanism.system->coordinates() > most_judged_coordinates) return {};
  const PressedBeams beams = pressed_beams(scene, analysis);
  if (!beams.has_stiffening()) return {};
  std::set<int> instants = beams.instants();
  const Trajectory& trajectory = analysis.trajectory;
  State state;
  FastestRotor rotor;
  for (int i = 0; i < int_size(trajectory.time); ++i) {
    trajectory.states->load(i, state);
    rotor.see(mechanism, state, i);
  }
  if (rotor.instant >= 0) instants.insert(rotor.instant);
  std::optional<Instability> found;
  for (const int i : instants) {
    trajectory.states->load(i, state);
    const ElasticStability stability = elastic_stability(mechanism, state);
    if (stability.is_stable) continue;
    const double time = trajectory.time(i);
    const bool is_new = !known || stability.negative > known(time);
    if (found && !is_new) continue;
    const std::string turning = is_rotor(mechanism, state)
                                    ? fmt::format(", where it turns at {:.4g} rad/s,",
                                                  fastest_turn(mechanism, state).omega.norm())
                                    : "";
    found = Instability{fmt::format("At t = {:.4g} s{} the mechanism is not in stable equilibrium "
                                    "with its loads: {} {}",
                                    time, turning, stability.where, stability.how),
                        is_new};
    if (is_new) break;
  }
  return found;
}

std::vector<Doubt> doubt_unstable_members(const TrustedRun& run) {
  const Model& model = run.analysis.model;
  const bool is_too_large = model.mechanism.system->coordinates() > most_judged_coordinates;
  const bool is_off = run.problem.effects.geometric_stiffening == EffectChoice::off;
  if (is_too_large || is_off) {
    if (pressed_beams(run.problem.scene, run.analysis).instants().empty()) return {};
    if (!is_too_large) return doubt_with_stiffening(run);
    return {not_judged(fmt::format("it has more than {} coordinates.", most_judged_coordinates))};
  }
  const auto found = find_instability(run.problem.scene, run.analysis);
  if (!found) return {};
  return {{found->text + unseen, true}};
}

}  // namespace pleuel
