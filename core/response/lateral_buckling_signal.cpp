#include "core/response/lateral_buckling_signal.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/int_size.hpp"
#include "core/model/body_point.hpp"
#include "core/response/composed_signals.hpp"
#include "core/response/recovered_signal.hpp"
#include "core/response/section_forces.hpp"

namespace pleuel {

namespace {

using Parts = std::vector<const BodyModel*>;

/// N at both ends of an element and M at both ends, element by element.
class PlaneForces final : public Stations {
 public:
  PlaneForces(const BodyModel& body, BendingPlane plane)
      : body_(body), moment_(plane == BendingPlane::xy ? 2 : 1) {
    for (int e = 0; e < int_size(body.beam.elements); ++e) {
      stations_.push_back({{e}, double(e)});
      stations_.push_back({{e}, e + 1.0});
    }
  }

  int numbers() const override { return section_force_count; }
  Recovery recovery() const override {
    return section_recovery(body_, stations_, section_force_parts);
  }
  Recovery recovery_derivative(std::size_t k) const override {
    return section_recovery_derivative(body_, stations_, section_force_parts, k);
  }
  int channels() const override { return 2 * int_size(stations_); }
  int station(int channel) const override { return channel / 4 * 2 + channel % 2; }
  std::string describe(int channel) const override {
    return pleuel::describe(stations_[station(channel)], body_);
  }
  double value(int channel, const double* numbers) const override { return numbers[part(channel)]; }
  Numbers slopes(int channel, const double*) override {
    return Numbers::Unit(section_force_count, part(channel));
  }
  double design_slope(int, const double*, std::size_t) const override { return 0.0; }

 private:
  /// Which of N, M_y, M_z, T.
  int part(int channel) const { return channel % 4 < 2 ? 0 : moment_; }

  const BodyModel& body_;
  int moment_;
  std::vector<Station> stations_;
};

std::unique_ptr<Signal> plane_forces(const Parts& parts, const Model& model, BendingPlane plane) {
  std::vector<std::unique_ptr<Signal>> signals;
  for (const BodyModel* part : parts) {
    signals.push_back(
        make_recovered_signal(*part, model.gravity, std::make_unique<PlaneForces>(*part, plane)));
  }
  return std::make_unique<SignalList>(std::move(signals));
}

/// The elements of all parts of a beam in one.
template <class Scalar>
void append(Beam<Scalar>& beam, const Beam<Scalar>& more) {
  beam.elements.insert(beam.elements.end(), more.elements.begin(), more.elements.end());
}

Beam<double> whole_beam(const Parts& parts) {
  Beam<double> beam;
  for (const BodyModel* part : parts) append(beam, part->beam);
  return beam;
}

/// Which local axes are across a plane of bending: along which the beam buckles out of it, and about
/// which it turns then.
struct AcrossPlane {
  std::size_t along, about;
};
AcrossPlane across(BendingPlane plane) {
  if (plane == BendingPlane::xy) return {2, 1};
  return {1, 2};
}

LateralSupport support_of(const JointHold& hold, BendingPlane plane) {
  const auto [along, about] = across(plane);
  return {hold.displacements[along], hold.rotations[about], hold.rotations[0]};
}

std::vector<LateralSupport> lateral_supports(const Beam<double>& beam, BendingPlane plane,
                                             const std::vector<JointHold>& holds) {
  std::vector<LateralSupport> supports(beam.node_count());
  for (const JointHold& hold : holds) {
    LateralSupport& at = supports[static_cast<std::size_t>(find_place(beam, hold.at).node())];
    const LateralSupport more = support_of(hold, plane);
    at.deflection = at.deflection || more.deflection;
    at.slope = at.slope || more.slope;
    at.twist = at.twist || more.twist;
  }
  return supports;
}

/// As lateral_supports(), but of a beam and its fittings as one; at the ends that have several
/// joints with their fitting as the joints hold the beam alone, with its welds.
std::vector<LateralSupport> fitted_supports(const Beam<double>& beam, BendingPlane plane,
                                            const EndFittings& fittings,
                                            const std::vector<JointHold>& alone) {
  std::vector<JointHold> holds;
  std::array<int, 2> at_end = {0, 0};
  for (const EndHold& hold : fittings.holds()) {
    if (!hold.is_of_fitting) holds.push_back(hold.hold);
    if (hold.end >= 0) ++at_end[hold.end];
  }
  std::vector<LateralSupport> supports = lateral_supports(beam, plane, holds);
  const std::vector<LateralSupport> welded = lateral_supports(beam, plane, alone);
  if (fittings.is_fitted(0) && at_end[0] > 1) supports.front() = welded.front();
  if (fittings.is_fitted(1) && at_end[1] > 1) supports.back() = welded.back();
  return supports;
}

/// How an end goes on in its fitting. A single joint holds it as it holds both as one. Of several
/// the deflection is held where they are; slope and twist as they hold the weld together, and the
/// slope where deflections are held at two distances.
/// @param support  of the node, by all joints of the beam; changed
FittedEnd fitted_end(const EndFittings& fittings, int end, BendingPlane plane, double length,
                     LateralSupport& support) {
  constexpr double same_distance = 1e-9;
  FittedEnd fitted{fittings.reach(end), {}};
  std::vector<EndHold> holds = fittings.holds();
  std::erase_if(holds, [end](const EndHold& hold) { return hold.end != end; });
  if (holds.size() == 1) support = support_of(holds[0].hold, plane);
  const EndHold* pivot = nullptr;
  for (const EndHold& hold : holds) {
    if (!hold.is_of_fitting && hold.hold.displacements[0]) fitted.reach = {};
    if (!support_of(hold.hold, plane).deflection) continue;
    if (pivot == nullptr) pivot = &hold;
    const double apart = std::abs(hold.distance.value - pivot->distance.value);
    support.slope = support.slope || apart > same_distance * length;
  }
  if (pivot == nullptr) return fitted;
  support.deflection = true;
  fitted.pivot = pivot->distance;
  return fitted;
}

/// One plane of a member.
class LateralBucklingSignal final : public Signal {
 public:
  LateralBucklingSignal(LateralMember member, BendingPlane plane)
      : member_(std::move(member)), plane_(plane) {}

  int channels() const override { return 1; }
  std::string describe(int) const override {
    return plane_ == BendingPlane::xy ? "sideways along z" : "sideways along y";
  }

  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    values(0) = member_.buckling().share(member_.observe(state));
  }

  void add_gradient(const State& state, int, double weight, SignalGradient& gradient) override {
    LateralBuckling& buckling = member_.buckling();
    const PlaneLoad& load = member_.observe(state);
    const LateralModes modes = buckling.modes(load);
    if (modes.shapes.cols() == 0) return;
    for (const auto& [variable, beam] : member_.beam_x()) {
      gradient.design(variable) += weight * buckling.design_slope(beam, load, modes);
    }
    member_.add_gradient(state, weight * buckling.load_slopes(modes), gradient);
    member_.add_gradient(buckling.end_slopes(load, modes), weight, gradient);
  }

 private:
  LateralMember member_;
  BendingPlane plane_;
};

}  // namespace

LateralMember::LateralMember(const std::string& name, const Model& model, BendingPlane plane,
                             bool counts_outside)
    : name_(name),
      model_(model),
      plane_(plane),
      counts_outside_(counts_outside),
      parts_(model.parts(name)),
      beam_(whole_beam(parts_)),
      length_(beam_.node_position(beam_.node_count() - 1)),
      forces_(plane_forces(parts_, model, plane)),
      load_(4, beam_.elements.size()) {}

std::vector<JointHold> LateralMember::holds() const {
  std::vector<JointHold> holds = model_.holds.of(name_);
  const BodyModel& first = *parts_.front();
  if (!first.mesh.depends_on_design()) return holds;
  for (JointHold& hold : holds) {
    hold.at = position_of(beam_, held_place(first, hold.at)) / length_;
  }
  return holds;
}

void LateralMember::hold_from_outside(std::vector<LateralSupport>& supports) const {
  const HeldPlaces* held = counts_outside_ ? model_.holds.outside(name_) : nullptr;
  if (held == nullptr) return;
  const bool holds_deflection = held->displacements[across(plane_).along];
  const auto hold = [&](LateralSupport& at) {
    at.deflection = at.deflection || holds_deflection;
    at.twist = true;
  };
  for (const double at : held->at) {
    const ElementPlace place = find_place(beam_, at);
    hold(supports[static_cast<std::size_t>(place.element + (place.xi < 0.5 ? 0 : 1))]);
  }
  if (held->at.empty()) std::ranges::for_each(supports, hold);
}

LateralBuckling& LateralMember::buckling() {
  if (buckling_) return *buckling_;
  const std::vector<JointHold> alone = holds();
  const auto found = model_.fittings.find(name_);
  if (found == model_.fittings.end()) {
    std::vector<LateralSupport> held = lateral_supports(beam_, plane_, alone);
    hold_from_outside(held);
    return buckling_.emplace(beam_, plane_, std::move(held));
  }
  const EndFittings& fittings = found->second;
  std::vector<LateralSupport> supports = fitted_supports(beam_, plane_, fittings, alone);
  RigidEnds ends;
  for (int end = 0; end < 2; ++end) {
    if (!fittings.is_fitted(end)) continue;
    LateralSupport& support = end == 0 ? supports.front() : supports.back();
    ends_[end] = fitted_end(fittings, end, plane_, length_, support);
    ends[end] = {ends_[end].reach.value, ends_[end].pivot.value};
  }
  hold_from_outside(supports);
  return buckling_.emplace(beam_, plane_, std::move(supports), ends);
}

double LateralMember::full_length() const {
  double length = length_;
  const auto fittings = model_.fittings.find(name_);
  for (int end = 0; fittings != model_.fittings.end() && end < 2; ++end) {
    if (!fittings->second.is_fitted(end)) continue;
    length += std::max(0.0, fittings->second.reach(end).value);
  }
  return length;
}

const PlaneLoad& LateralMember::observe(const State& state) {
  forces_->observe(state, load_.reshaped());
  return load_;
}

void LateralMember::add_gradient(const State& state, const PlaneLoad& weights,
                                 SignalGradient& gradient) {
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    const double weight = weights.reshaped()(i);
    if (weight != 0.0) forces_->add_gradient(state, static_cast<int>(i), weight, gradient);
  }
}

void LateralMember::add_gradient(const RigidEnds& slopes, double weight,
                                 SignalGradient& gradient) const {
  for (std::size_t end = 0; end < 2; ++end) {
    for (const auto& [variable, slope] : ends_[end].reach.slopes) {
      gradient.design(variable) += weight * slopes[end].reach * slope;
    }
    for (const auto& [variable, slope] : ends_[end].pivot.slopes) {
      gradient.design(variable) += weight * slopes[end].pivot * slope;
    }
  }
}

const std::vector<std::pair<int, Beam<Dual>>>& LateralMember::beam_x() {
  if (!beam_x_.empty()) return beam_x_;
  for (const auto& [variable, beam] : parts_.front()->beam_x) beam_x_.emplace_back(variable, beam);
  for (std::size_t i = 1; i < parts_.size(); ++i) {
    for (std::size_t k = 0; k < beam_x_.size(); ++k) {
      append(beam_x_[k].second, parts_[i]->beam_x[k].second);
    }
  }
  return beam_x_;
}

std::vector<BendingPlane> bending_planes(const BodyModel& body) {
  const BodyFrame& frame = body.frame;
  if (frame.rotation != RotationCoordinates::angle) return {BendingPlane::xy, BendingPlane::xz};
  const Eigen::Vector3d out = frame.reference.transpose() * frame.axis;
  return {std::abs(out.z()) > 0.5 ? BendingPlane::xy : BendingPlane::xz};
}

std::unique_ptr<Signal> make_lateral_buckling_signal(const std::string& name, const Model& model) {
  std::vector<std::unique_ptr<Signal>> signals;
  for (const BendingPlane plane : bending_planes(*model.parts(name).front())) {
    LateralMember member(name, model, plane);
    if (!member.buckling().is_held()) return nullptr;
    signals.push_back(std::make_unique<LateralBucklingSignal>(std::move(member), plane));
  }
  return std::make_unique<SignalList>(std::move(signals));
}

}  // namespace pleuel
