#include "core/response/signal_of_body.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/response/body_strengths.hpp"
#include "core/response/buckling_signal.hpp"
#include "core/response/composed_signals.hpp"
#include "core/response/divided_deflection.hpp"
#include "core/response/fatigue_signal.hpp"
#include "core/response/lateral_buckling_signal.hpp"
#include "core/response/line_buckling.hpp"
#include "core/response/motion_signals.hpp"
#include "core/response/place_deflection.hpp"
#include "core/response/point_stress_signal.hpp"
#include "core/response/response.hpp"
#include "core/response/section_force_signal.hpp"
#include "core/response/stress_signal.hpp"

namespace pleuel {

namespace {

/// Whether the peak of both planes of bending is the larger one of their peaks. Then each is a
/// channel of its own; else at each instant the plane counts that is nearer to buckling.
bool takes_larger_peak(OverTime kind) {
  return kind == OverTime::max || kind == OverTime::max_abs;
}

template <class One>
concept OfStress = requires(const One& one) {
  one.where;
};

/// Signals of a body, or of a part of one.
class BodySignalMaker {
 public:
  BodySignalMaker(const ResponseSettings& settings, const Model& model, const BodyModel& body)
      : settings_(settings), model_(model), body_(body) {}

  std::unique_ptr<Signal> make(const StressResponse& stress) const {
    if (body_.is_imported()) {
      check_elastic();
      return make_point_stress_signal(body_, model_.gravity, stress.part, stress.where.place);
    }
    check_section_forces(stress.part == StressPart::axial, stress.part == StressPart::shear);
    const bool has_strength = strengths_of(body_).yield > 0.0;
    if (stress.part == StressPart::utilization && !has_strength) {
      fail(fmt::format("the material of \"{}\" has no strength", body_.name));
    }
    const bool is_averaged = settings_.over_time == OverTime::mean ||
                             settings_.over_time == OverTime::rms ||
                             settings_.over_time == OverTime::integral;
    return make_stress_signal(body_, model_.gravity, stress.part,
                              is_averaged ? OutlinePoints::fixed : OutlinePoints::most_stressed,
                              {stress.where.segment, stress.where.station});
  }

  std::unique_ptr<Signal> make(const ShearStressResponse& stress) const {
    check_section_forces(false, true);
    for (const BeamElement<double>& element : body_.beam.elements) {
      if (!element.section.shear_points.empty()) continue;
      fail(
          fmt::format("\"{}\" has a general section, whose properties do not tell where shear "
                      "forces act in it",
                      body_.name));
    }
    return make_shear_stress_signal(body_, model_.gravity,
                                    {stress.where.segment, stress.where.station});
  }

  std::unique_ptr<Signal> make(const FatigueResponse& fatigue) const {
    std::unique_ptr<Signal> stress;
    if (body_.is_imported()) {
      check_elastic();
      stress = make_plane_stress_signal(body_, model_.gravity, fatigue.where.place);
    } else {
      check_section_forces(false, false);
      stress = make_stress_signal(body_, model_.gravity, StressPart::normal, OutlinePoints::fixed,
                                  {fatigue.where.segment, fatigue.where.station});
    }
    check_fatigue_data(fatigue);
    return make_fatigue_signal(std::move(stress), body_, variables(), cycle_strengths(fatigue));
  }

  std::unique_ptr<Signal> make(const SectionForceResponse& force) const {
    check_section_forces(force.part == SectionForcePart::axial,
                         force.part == SectionForcePart::torque);
    return make_section_force_signal(body_, model_.gravity, force.part,
                                     {std::nullopt, force.station, force.side});
  }

  /// Of the whole beam, also where the body is a part of it.
  std::unique_ptr<Signal> make(const BucklingResponse& buckling) const {
    if (body_.is_imported()) return make_line_buckling(*buckling.chord);
    check_section_forces(true, false);
    std::vector<std::unique_ptr<Signal>> parts;
    for (const BodyModel* part : model_.parts(body_.name)) {
      parts.push_back(make_compression_signal(*part, model_.gravity));
    }
    std::vector<DesignFactor> loads = euler_loads(model_.body(body_.name), variables());
    if (!takes_larger_peak(settings_.over_time)) {
      const auto is_weaker = [](const DesignFactor& a, const DesignFactor& b) {
        return a.value < b.value;
      };
      loads = {*std::ranges::min_element(loads, is_weaker)};
    }
    return make_buckling_signal(std::make_unique<SignalList>(std::move(parts)), loads);
  }

  /// The same.
  std::unique_ptr<Signal> make(const LateralBucklingResponse&) const {
    check_section_forces(true, false);
    auto signal = make_lateral_buckling_signal(body_.name, model_);
    if (!signal) {
      fail(
          fmt::format("no joint holds \"{}\" where it would buckle; springs, loads and bodies that "
                      "it carries hold nothing",
                      body_.name));
    }
    if (takes_larger_peak(settings_.over_time) || signal->channels() == 1) return signal;
    return std::make_unique<LargestSignal>(std::move(signal), "sideways in either plane");
  }

  std::unique_ptr<Signal> make(const DeflectionResponse& deflection) const {
    switch (deflection.against) {
      case DeflectionReference::frame:
        if (body_.is_imported()) check_elastic();
        return make_deflection_signal(body_, named(deflection.point), deflection.direction);
      case DeflectionReference::chord:
        return make_chord_deflection(deflection);
      default:  // the position in the rigid mechanism is taken off afterwards
        return make(PointMotionResponse{deflection.point, {deflection.direction}});
    }
  }

  std::unique_ptr<Signal> make(const PointMotionResponse& motion) const {
    return make_motion_signal(body_, named(motion.point), motion.component.direction,
                              motion.derivative);
  }

  std::unique_ptr<Signal> make(const TurningResponse& turning) const {
    const int direction = turning.component.direction;
    if (turning.derivative == TimeDerivative::none) return make_angle_signal(body_, direction);
    return make_spin_signal(body_, direction, turning.derivative);
  }

  /// Where an axis of the body frame points.
  std::unique_ptr<Signal> make_axis(int axis) const { return make_axis_signal(body_, axis); }

 private:
  [[noreturn]] void fail(const std::string& why) const { refuse_response(settings_.name, why); }

  int variables() const { return model_.mechanism.system->variables(); }

  void check_elastic() const {
    if (!body_.is_elastic) fail(fmt::format("\"{}\" is rigid", body_.name));
  }

  /// Section forces come from strain.
  void check_section_forces(bool needs_axial, bool needs_twist) const {
    check_elastic();
    if (needs_axial && !has_displacement(0)) {
      fail(fmt::format("\"{}\" has no axial elasticity", body_.name));
    }
    const bool can_twist = body_.frame.rotation == RotationCoordinates::rotation_vector;
    if (needs_twist && can_twist && !has_displacement(3)) {
      fail(fmt::format("\"{}\" has no torsional elasticity", body_.name));
    }
  }

  static CycleStrengths cycle_strengths(const FatigueResponse& fatigue) {
    using S = Strengths<double>;
    return {fatigue.kind == FatigueNumber::utilization ? &S::endurance_limit : &S::fatigue,
            fatigue.criterion == FatigueCriterion::soderberg ? &S::yield : &S::ultimate};
  }

  void check_fatigue_data(const FatigueResponse& fatigue) const {
    const Strengths<double> strengths = strengths_of(body_);
    const CycleStrengths needed = cycle_strengths(fatigue);
    const bool is_damage = fatigue.kind == FatigueNumber::damage;
    const bool is_yield = fatigue.criterion == FatigueCriterion::soderberg;
    const bool has_exponent = !is_damage || strengths.fatigue_exponent > 0.0;
    if (has_exponent && strengths.*needed.of_amplitude > 0.0 && strengths.*needed.of_mean > 0.0) {
      return;
    }
    fail(fmt::format("the material of \"{}\" needs {} and {}", body_.name,
                     is_damage ? "a fatigue strength with its exponent" : "an endurance limit",
                     is_yield ? "a strength" : "an ultimate strength"));
  }

  bool has_displacement(int direction) const {
    const ElasticCoordinates& coordinates = body_.coordinates;
    for (int node = 0; node < coordinates.node_count(); ++node) {
      if (coordinates.index(node, direction) >= 0) return true;
    }
    return false;
  }

  std::unique_ptr<Signal> make_line_buckling(const std::array<std::string, 2>& chord) const {
    check_elastic();
    try {
      return make_buckling_signal(make_line_compression_signal(body_, model_.gravity),
                                  {pinned_line_load(body_, chord, variables())});
    } catch (const InputError& error) {
      fail(error.what());
    }
  }

  /// The point that a response looks at.
  NamedPoint named(const ResponsePoint& point) const {
    if (body_.is_beam()) return point_along(point.at);
    if (!body_.is_imported()) return {{}, "reference point"};
    return named_point(body_, point.place);
  }

  NamedPoint point_along(double share) const {
    return {point_of(body_, place_at(body_, share)),
            fmt::format("at {:g} of the length", body_.stretch.of_whole(share))};
  }

  /// Against the straight line through both ends of a beam, whatever its frame.
  std::unique_ptr<Signal> make_chord_deflection(const DeflectionResponse& deflection) const {
    if (deflection.chord) {
      check_elastic();
      return make_place_deflection(body_, deflection.point.place, *deflection.chord, variables(),
                                   deflection.direction);
    }
    const double at = deflection.point.at;
    std::vector<SignalSum::Part> parts;
    for (const auto& [factor, share] :
         {std::pair(1.0, at), std::pair(at - 1.0, 0.0), std::pair(-at, 1.0)}) {
      parts.push_back(
          {factor, make_deflection_signal(body_, point_along(share), deflection.direction)});
    }
    return std::make_unique<SignalSum>(std::move(parts));
  }

  const ResponseSettings& settings_;
  const Model& model_;
  const BodyModel& body_;
};

template <class One>
concept OfBody = requires(const BodySignalMaker& maker, const One& one) {
  maker.make(one);
};

/// Signals of a beam that is divided into frames, from those of its parts.
class DividedSignalMaker {
 public:
  DividedSignalMaker(const ResponseSettings& settings, const Model& model,
                     std::vector<const BodyModel*> parts)
      : settings_(settings), model_(model), parts_(std::move(parts)) {}

  template <class Other>
  std::unique_ptr<Signal> make(const Other& response) const {
    return of_part(*parts_.front()).make(response);
  }

  /// Of all parts that are looked at.
  template <OfStress One>
  std::unique_ptr<Signal> make(const One& stress) const {
    std::vector<std::unique_ptr<Signal>> signals;
    for (const BodyModel* part : parts_) {
      One of_it = stress;
      if (of_it.where.segment && !holds_segment(*part, *of_it.where.segment)) continue;
      if (is_placed(*part, of_it.where.station)) signals.push_back(of_part(*part).make(of_it));
    }
    return std::make_unique<SignalList>(std::move(signals));
  }

  std::unique_ptr<Signal> make(const SectionForceResponse& force) const {
    std::vector<std::unique_ptr<Signal>> signals;
    for (const BodyModel* part : parts_) {
      SectionForceResponse of_it = force;
      if (is_placed(*part, of_it.station)) signals.push_back(of_part(*part).make(of_it));
    }
    // Where two parts meet, the place is the end of one and the beginning of the other.
    if (force.side && signals.size() > 1) {
      return std::move(*force.side == SectionSide::before ? signals.front() : signals.back());
    }
    return std::make_unique<SignalList>(std::move(signals));
  }

  std::unique_ptr<Signal> make(const PointMotionResponse& motion) const {
    return make_at_place(motion);
  }

  std::unique_ptr<Signal> make(const DeflectionResponse& deflection) const {
    if (deflection.against == DeflectionReference::rigid_mechanism) {
      return make_at_place(deflection);
    }
    if (deflection.direction == 0) {
      refuse_response(settings_.name,
                      fmt::format("\"{}\" is divided into frames, of which each has an axis of its "
                                  "own: take the direction y or z",
                                  deflection.point.body));
    }
    const ReferenceCondition frame = parts_.front()->condition;
    const bool is_chord =
        deflection.against == DeflectionReference::chord || frame == ReferenceCondition::chord;
    if (!is_chord && frame == ReferenceCondition::mean_axis) {
      refuse_response(settings_.name,
                      fmt::format("\"{}\" is divided into frames and has no mean axis as a whole: "
                                  "measure against the chord",
                                  deflection.point.body));
    }
    const bool is_at_end = !is_chord && frame == ReferenceCondition::tangent_end;
    const BodyModel& clamped = is_at_end ? *parts_.back() : *parts_.front();
    const int axis = is_chord ? 3 - deflection.direction : deflection.direction;
    return make_divided_deflection(
        {make_position(deflection.point, deflection.point.at),
         make_position(deflection.point, is_at_end ? 1.0 : 0.0),
         make_position(deflection.point, 1.0), of_part(clamped).make_axis(axis)},
        is_chord ? DividedReference::chord : DividedReference::tangent, deflection.direction);
  }

 private:
  /// Places nearer to the end of a part than this share of the beam are on it, too.
  static constexpr double rounding_tolerance = 1e-9;

  BodySignalMaker of_part(const BodyModel& part) const { return {settings_, model_, part}; }

  static bool holds(const BodyModel& part, double share) {
    return part.stretch.begin - rounding_tolerance <= share &&
           share <= part.stretch.end + rounding_tolerance;
  }

  /// Whether a part is looked at.
  /// @param station  becomes a share of the part
  static bool is_placed(const BodyModel& part, std::optional<double>& station) {
    if (!station) return true;
    const bool is_there = holds(part, *station);
    station = part.stretch.within(*station);
    return is_there;
  }

  const BodyModel& part_at(double share) const {
    for (const BodyModel* part : parts_) {
      if (holds(*part, share)) return *part;
    }
    return *parts_.back();
  }

  template <class OfPoint>
  std::unique_ptr<Signal> make_at_place(OfPoint response) const {
    double& at = response.point.at;
    const BodyModel& part = part_at(at);
    at = part.stretch.within(at);
    return of_part(part).make(response);
  }

  static bool holds_segment(const BodyModel& part, int segment) {
    const std::vector<MeshElement>& elements = part.mesh.elements;
    return std::ranges::any_of(
        elements, [&](const MeshElement& element) { return element.segment == segment; });
  }

  /// Position of a place, global x, y, z.
  std::unique_ptr<Signal> make_position(ResponsePoint point, double at) const {
    point.at = at;
    std::vector<std::unique_ptr<Signal>> components;
    for (int direction = 0; direction < 3; ++direction) {
      components.push_back(make_at_place(PointMotionResponse{point, {direction}}));
    }
    return std::make_unique<SignalList>(std::move(components));
  }

  const ResponseSettings& settings_;
  const Model& model_;
  std::vector<const BodyModel*> parts_;
};

/// A signal whose places are named with their body.
class SignalOfNamedBody final : public Signal {
 public:
  SignalOfNamedBody(std::string body, std::unique_ptr<Signal> signal)
      : body_(std::move(body)), signal_(std::move(signal)) {}

  int channels() const override { return signal_->channels(); }
  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    signal_->observe(state, values);
  }
  void add_gradient(const State& state, int channel, double weight,
                    SignalGradient& gradient) override {
    signal_->add_gradient(state, channel, weight, gradient);
  }
  std::string describe(int channel) const override {
    return body_ + ", " + signal_->describe(channel);
  }

 private:
  std::string body_;
  std::unique_ptr<Signal> signal_;
};

/// Signals of whole bodies, and those that are made from several of them.
class SignalMaker {
 public:
  SignalMaker(const ResponseSettings& settings, const Model& model)
      : settings_(settings), model_(model), bodies_(bodies_of(settings)) {}

  template <class Other>
  std::unique_ptr<Signal> make(const Other&) const {
    throw std::logic_error("a response without a signal");
  }

  template <OfBody One>
  std::unique_ptr<Signal> make(const One& response) const {
    return of_body(bodies_.front(), response);
  }

  /// The largest of several bodies.
  template <OfBody One>
  requires OfStress<One> std::unique_ptr<Signal> make(const One& stress)
  const {
    if (bodies_.size() == 1) return of_body(bodies_.front(), stress);
    std::vector<std::unique_ptr<Signal>> signals;
    for (const std::string& body : bodies_) {
      signals.push_back(std::make_unique<SignalOfNamedBody>(body, of_body(body, stress)));
    }
    return std::make_unique<SignalList>(std::move(signals));
  }

  /// The resultant is √(y² + z²).
  std::unique_ptr<Signal> make(const DeflectionResponse& deflection) const {
    if (deflection.direction != magnitude_direction) return of_body(bodies_.front(), deflection);
    DeflectionResponse along_y = deflection, along_z = deflection;
    along_y.direction = 1;
    along_z.direction = 2;
    return std::make_unique<NormSignal>(make(along_y), make(along_z));
  }

  /// The component along a vector is made from those along the global axes.
  template <OfBody One>
  requires requires(const One& one) { one.component; }
  std::unique_ptr<Signal> make(const One& motion) const {
    if (!motion.component.along) return of_body(bodies_.front(), motion);
    const std::array<double, 3> along = *motion.component.along;
    std::vector<SignalSum::Part> parts;
    for (int i = 0; i < 3; ++i) {
      One along_axis = motion;
      along_axis.component = {i};
      parts.push_back({along[i], of_body(bodies_.front(), along_axis)});
    }
    return std::make_unique<SignalSum>(
        std::move(parts),
        fmt::format("along ({:.3g}, {:.3g}, {:.3g})", along[0], along[1], along[2]));
  }

 private:
  template <OfBody One>
  std::unique_ptr<Signal> of_body(const std::string& body, const One& response) const {
    const std::vector<const BodyModel*> parts = model_.parts(body);
    if (parts.size() > 1) return DividedSignalMaker(settings_, model_, parts).make(response);
    return BodySignalMaker(settings_, model_, *parts.front()).make(response);
  }

  const ResponseSettings& settings_;
  const Model& model_;
  std::vector<std::string> bodies_;
};

}  // namespace

std::unique_ptr<Signal> make_signal_of_body(const ResponseSettings& settings, const Model& model) {
  const SignalMaker maker(settings, model);
  return std::visit([&](const auto& one) { return maker.make(one); }, settings.what);
}

}  // namespace pleuel
