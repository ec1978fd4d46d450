#include "core/trust/critical_instants.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "core/base/int_size.hpp"
#include "core/linear/turning.hpp"
#include "core/response/lateral_buckling_signal.hpp"

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

}  // namespace

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

}  // namespace pleuel
