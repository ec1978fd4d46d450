#include "core/trust/unstable_members.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include "core/integration/elastic_stability.hpp"
#include "core/integration/turning.hpp"
#include "core/response/lateral_buckling_signal.hpp"

namespace pleuel {

namespace {

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
  double most = 0.0;
  int instant = -1;

  PressedBeam(const std::string& name, const Model& model)
      : member(name, model, BendingPlane::xy), most(harmless_press * euler_load(member)) {}

  void see(const State& state, int now) {
    const double press = -member.observe(state).topRows<2>().minCoeff();
    if (!(press > most)) return;
    most = press;
    instant = now;
  }
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

std::vector<PressedBeam> beams_of(const Scene& scene, const Model& model) {
  std::vector<PressedBeam> beams;
  for (const Body& body : scene.bodies) {
    if (!std::holds_alternative<BeamBody>(body.shape)) continue;
    const BodyModel& part = *model.parts(body.name).front();
    const bool is_planar = part.frame.rotation == RotationCoordinates::angle;
    if (part.is_elastic && part.has_stiffening && !is_planar) beams.emplace_back(body.name, model);
  }
  return beams;
}

}  // namespace

std::optional<Instability> find_instability(const Scene& scene, const Analysis& analysis,
                                            const std::function<int(double)>& known) {
  const Mechanism& mechanism = analysis.model.mechanism;
  if (mechanism.system->coordinates() > most_judged_coordinates) return {};
  std::vector<PressedBeam> beams = beams_of(scene, analysis.model);
  if (beams.empty()) return {};
  const Trajectory& trajectory = analysis.trajectory;
  State state;
  FastestRotor rotor;
  for (int i = 0; i < static_cast<int>(trajectory.time.size()); ++i) {
    trajectory.states->load(i, state);
    for (PressedBeam& beam : beams) beam.see(state, i);
    rotor.see(mechanism, state, i);
  }
  std::set<int> instants;
  for (const PressedBeam& beam : beams) {
    if (beam.instant >= 0) instants.insert(beam.instant);
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
  const auto found = find_instability(run.problem.scene, run.analysis);
  if (!found) return {};
  return {{found->text + ". In the motion a member that is exactly straight stays so. Make it "
                         "stiffer, or hold it.",
           true}};
}

}  // namespace pleuel
