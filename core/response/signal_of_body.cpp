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
#include "core/scene/response_kind.hpp"

namespace pleuel {

namespace {

/// Whether the peak of both planes of bending is the larger one of their peaks. Then each is a
/// channel of its own; else at each instant the plane counts that is nearer to buckling.
bool takes_larger_peak(OverTime kind) {
  return kind == OverTime::max || kind == OverTime::max_abs;
}

class BodySignalMaker {
 public:
  BodySignalMaker(const ResponseSettings& settings, const Model& model, const BodyModel& body)
      : settings_(settings), model_(model), body_(body) {}

  std::unique_ptr<Signal> make() const {
    switch (observed_type(settings_.type)) {
      case ResponseType::stress:
        return make_stress();
      case ResponseType::fatigue:
      case ResponseType::fatigue_damage:
        return make_fatigue();
      case ResponseType::shear_stress:
        return make_shear_stress();
      case ResponseType::buckling:
        return make_buckling();
      case ResponseType::lateral_buckling:
        return make_lateral_buckling();
      case ResponseType::deflection:
        return make_deflection();
      case ResponseType::position:
        return make_motion(TimeDerivative::none);
      case ResponseType::velocity:
        return make_motion(TimeDerivative::first);
      case ResponseType::section_force:
        check_section_forces();
        return make_section_force_signal(body_, model_.gravity, settings_.section_part,
                                         {std::nullopt, settings_.station, settings_.side});
      case ResponseType::angular_velocity:
        return make_spin_signal(body_, settings_.direction, TimeDerivative::first);
      case ResponseType::angular_acceleration:
        return make_spin_signal(body_, settings_.direction, TimeDerivative::second);
      case ResponseType::angle:
        return make_angle_signal(body_, settings_.direction);
      case ResponseType::acceleration:
        return make_motion(TimeDerivative::second);
      default:
        throw std::logic_error("a response without a signal");
    }
  }

  /// Where an axis of the body frame points.
  std::unique_ptr<Signal> make_axis(int axis) const { return make_axis_signal(body_, axis); }

 private:
  [[noreturn]] void fail(const std::string& why) const { refuse_response(settings_.name, why); }

  void check_elastic() const {
    if (!body_.is_elastic) fail(fmt::format("\"{}\" is rigid", body_.name));
  }

  /// Section forces come from strain.
  void check_section_forces() const {
    check_elastic();
    const bool is_section_force = settings_.type == ResponseType::section_force;
    const bool needs_axial =
        settings_.type == ResponseType::buckling ||
        settings_.type == ResponseType::lateral_buckling || settings_.part == StressPart::axial ||
        (is_section_force && settings_.section_part == SectionForcePart::axial);
    if (needs_axial && !has_displacement(0)) {
      fail(fmt::format("\"{}\" has no axial elasticity", body_.name));
    }
    const bool is_twist = settings_.part == StressPart::shear ||
                          settings_.type == ResponseType::shear_stress ||
                          (is_section_force && settings_.section_part == SectionForcePart::torque);
    const bool needs_twist =
        is_twist && body_.frame.rotation == RotationCoordinates::rotation_vector;
    if (needs_twist && !has_displacement(3)) {
      fail(fmt::format("\"{}\" has no torsional elasticity", body_.name));
    }
    const bool has_strength = strengths_of(body_).yield > 0.0;
    if (settings_.part == StressPart::utilization && !has_strength) {
      fail(fmt::format("the material of \"{}\" has no strength", body_.name));
    }
  }

  CycleStrengths cycle_strengths() const {
    using S = Strengths<double>;
    return {settings_.type == ResponseType::fatigue ? &S::endurance_limit : &S::fatigue,
            settings_.criterion == FatigueCriterion::soderberg ? &S::yield : &S::ultimate};
  }

  std::unique_ptr<Signal> make_fatigue() const {
    std::unique_ptr<Signal> stress;
    if (body_.is_imported()) {
      check_elastic();
      stress = make_plane_stress_signal(body_, model_.gravity, settings_.place);
    } else {
      check_section_forces();
      stress = make_stress_signal(body_, model_.gravity, StressPart::normal, OutlinePoints::fixed,
                                  {settings_.segment, settings_.station});
    }
    check_fatigue_data();
    return make_fatigue_signal(std::move(stress), body_, model_.mechanism.system->variables(),
                               cycle_strengths());
  }

  void check_fatigue_data() const {
    const Strengths<double> strengths = strengths_of(body_);
    const CycleStrengths needed = cycle_strengths();
    const bool is_damage = settings_.type == ResponseType::fatigue_damage;
    const bool is_yield = settings_.criterion == FatigueCriterion::soderberg;
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

  std::unique_ptr<Signal> make_stress() const {
    if (body_.is_imported()) {
      check_elastic();
      return make_point_stress_signal(body_, model_.gravity, settings_.part, settings_.place);
    }
    check_section_forces();
    const bool is_averaged = settings_.over_time == OverTime::mean ||
                             settings_.over_time == OverTime::rms ||
                             settings_.over_time == OverTime::integral;
    return make_stress_signal(body_, model_.gravity, settings_.part,
                              is_averaged ? OutlinePoints::fixed : OutlinePoints::most_stressed,
                              {settings_.segment, settings_.station});
  }

  std::unique_ptr<Signal> make_shear_stress() const {
    check_section_forces();
    for (const BeamElement<double>& element : body_.beam.elements) {
      if (!element.section.shear_points.empty()) continue;
      fail(
          fmt::format("\"{}\" has a general section, whose properties do not tell where shear "
                      "forces act in it",
                      body_.name));
    }
    return make_shear_stress_signal(body_, model_.gravity, {settings_.segment, settings_.station});
  }

  /// Of the whole beam, also where the body is a part of it.
  std::unique_ptr<Signal> make_buckling() const {
    if (body_.is_imported()) return make_line_buckling();
    check_section_forces();
    std::vector<std::unique_ptr<Signal>> parts;
    for (const BodyModel* part : model_.parts(body_.name)) {
      parts.push_back(make_compression_signal(*part, model_.gravity));
    }
    std::vector<DesignFactor> loads =
        euler_loads(model_.body(body_.name), model_.mechanism.system->variables());
    if (!takes_larger_peak(settings_.over_time)) {
      const auto is_weaker = [](const DesignFactor& a, const DesignFactor& b) {
        return a.value < b.value;
      };
      loads = {*std::ranges::min_element(loads, is_weaker)};
    }
    return make_buckling_signal(std::make_unique<SignalList>(std::move(parts)), loads);
  }

  std::unique_ptr<Signal> make_line_buckling() const {
    check_elastic();
    try {
      return make_buckling_signal(
          make_line_compression_signal(body_, model_.gravity),
          {pinned_line_load(body_, *settings_.chord, model_.mechanism.system->variables())});
    } catch (const InputError& error) {
      fail(error.what());
    }
  }

  /// The same.
  std::unique_ptr<Signal> make_lateral_buckling() const {
    check_section_forces();
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

  /// The point that the response looks at.
  NamedPoint point() const {
    if (body_.is_beam()) return point_along(settings_.at);
    if (!body_.is_imported()) return {{}, "reference point"};
    return named_point(body_, settings_.place);
  }

  NamedPoint point_along(double share) const {
    return {point_of(body_, place_at(body_, share)),
            fmt::format("at {:g} of the length", body_.stretch.of_whole(share))};
  }

  std::unique_ptr<Signal> make_motion(TimeDerivative derivative) const {
    return make_motion_signal(body_, point(), settings_.direction, derivative);
  }

  std::unique_ptr<Signal> make_deflection() const {
    switch (settings_.against) {
      case DeflectionReference::frame:
        if (body_.is_imported()) check_elastic();
        return make_deflection_signal(body_, point(), settings_.direction);
      case DeflectionReference::chord:
        return make_chord_deflection();
      default:  // the position in the rigid mechanism is taken off afterwards
        return make_motion(TimeDerivative::none);
    }
  }

  /// Against the straight line through both ends of a beam, whatever its frame.
  std::unique_ptr<Signal> make_chord_deflection() const {
    if (settings_.chord) {
      check_elastic();
      return make_place_deflection(body_, settings_.place, *settings_.chord,
                                   model_.mechanism.system->variables(), settings_.direction);
    }
    const double at = settings_.at;
    std::vector<SignalSum::Part> parts;
    for (const auto& [factor, share] :
         {std::pair(1.0, at), std::pair(at - 1.0, 0.0), std::pair(-at, 1.0)}) {
      parts.push_back(
          {factor, make_deflection_signal(body_, point_along(share), settings_.direction)});
    }
    return std::make_unique<SignalSum>(std::move(parts));
  }

  const ResponseSettings& settings_;
  const Model& model_;
  const BodyModel& body_;
};

/// Signals of a beam that is divided into frames, from those of its parts.
class DividedSignalMaker {
 public:
  DividedSignalMaker(const ResponseSettings& settings, const Model& model)
      : settings_(settings), model_(model), parts_(model.parts(settings.bodies.front())) {}

  std::unique_ptr<Signal> make() const {
    switch (observed_type(settings_.type)) {
      case ResponseType::stress:
      case ResponseType::fatigue:
      case ResponseType::fatigue_damage:
      case ResponseType::shear_stress:
      case ResponseType::section_force:
        return make_stress();
      case ResponseType::deflection:
        if (settings_.against == DeflectionReference::rigid_mechanism) break;
        return make_deflection();
      default:
        break;
    }
    const BodyModel& part = part_at(settings_.at);
    ResponseSettings settings = settings_;
    settings.at = part.stretch.within(settings.at);
    return make_of(settings, part);
  }

 private:
  /// Places nearer to the end of a part than this share of the beam are on it, too.
  static constexpr double rounding_tolerance = 1e-9;

  std::unique_ptr<Signal> make_of(const ResponseSettings& settings, const BodyModel& part) const {
    return BodySignalMaker(settings, model_, part).make();
  }

  static bool holds(const BodyModel& part, double share) {
    return part.stretch.begin - rounding_tolerance <= share &&
           share <= part.stretch.end + rounding_tolerance;
  }

  const BodyModel& part_at(double share) const {
    for (const BodyModel* part : parts_) {
      if (holds(*part, share)) return *part;
    }
    return *parts_.back();
  }

  static bool holds_segment(const BodyModel& part, int segment) {
    const std::vector<MeshElement>& elements = part.mesh.elements;
    return std::ranges::any_of(
        elements, [&](const MeshElement& element) { return element.segment == segment; });
  }

  std::unique_ptr<Signal> make_stress() const {
    std::vector<std::unique_ptr<Signal>> signals;
    for (const BodyModel* part : parts_) {
      ResponseSettings settings = settings_;
      if (settings.station) {
        if (!holds(*part, *settings.station)) continue;
        settings.station = part->stretch.within(*settings.station);
      }
      if (settings.segment && !holds_segment(*part, *settings.segment)) continue;
      signals.push_back(make_of(settings, *part));
    }
    // Where two parts meet, the place is the end of one and the beginning of the other.
    if (settings_.side && signals.size() > 1) {
      return std::move(*settings_.side == SectionSide::before ? signals.front() : signals.back());
    }
    return std::make_unique<SignalList>(std::move(signals));
  }

  /// Position of a place, global x, y, z.
  std::unique_ptr<Signal> make_position(double at) const {
    const BodyModel& part = part_at(at);
    ResponseSettings settings = settings_;
    settings.type = ResponseType::position;
    settings.at = part.stretch.within(at);
    std::vector<std::unique_ptr<Signal>> components;
    for (int direction = 0; direction < 3; ++direction) {
      settings.direction = direction;
      components.push_back(make_of(settings, part));
    }
    return std::make_unique<SignalList>(std::move(components));
  }

  std::unique_ptr<Signal> make_deflection() const {
    if (settings_.direction == 0) {
      refuse_response(settings_.name,
                      fmt::format("\"{}\" is divided into frames, of which each has an axis of its "
                                  "own: take the direction y or z",
                                  settings_.bodies.front()));
    }
    const ReferenceCondition frame = parts_.front()->condition;
    const bool is_chord =
        settings_.against == DeflectionReference::chord || frame == ReferenceCondition::chord;
    if (!is_chord && frame == ReferenceCondition::mean_axis) {
      refuse_response(settings_.name,
                      fmt::format("\"{}\" is divided into frames and has no mean axis as a whole: "
                                  "measure against the chord",
                                  settings_.bodies.front()));
    }
    const bool is_at_end = !is_chord && frame == ReferenceCondition::tangent_end;
    const BodyModel& clamped = is_at_end ? *parts_.back() : *parts_.front();
    const int axis = is_chord ? 3 - settings_.direction : settings_.direction;
    return make_divided_deflection(
        {make_position(settings_.at), make_position(is_at_end ? 1.0 : 0.0), make_position(1.0),
         BodySignalMaker(settings_, model_, clamped).make_axis(axis)},
        is_chord ? DividedReference::chord : DividedReference::tangent, settings_.direction);
  }

  const ResponseSettings& settings_;
  const Model& model_;
  std::vector<const BodyModel*> parts_;
};

}  // namespace

namespace {

/// √(y² + z²) of a deflection.
std::unique_ptr<Signal> make_resultant(ResponseSettings settings, const Model& model) {
  settings.direction = 1;
  auto along_y = make_signal_of_body(settings, model);
  settings.direction = 2;
  return std::make_unique<NormSignal>(std::move(along_y), make_signal_of_body(settings, model));
}

/// The component along a vector, of those along the global axes.
std::unique_ptr<Signal> make_along(ResponseSettings settings, const Model& model) {
  const std::array<double, 3> along = *std::exchange(settings.along, std::nullopt);
  std::vector<SignalSum::Part> parts;
  for (int i = 0; i < 3; ++i) {
    settings.direction = i;
    parts.push_back({along[i], make_signal_of_body(settings, model)});
  }
  return std::make_unique<SignalSum>(std::move(parts), fmt::format("along ({:.3g}, {:.3g}, {:.3g})",
                                                                   along[0], along[1], along[2]));
}

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

/// Stress of several bodies.
std::unique_ptr<Signal> make_list(ResponseSettings settings, const Model& model) {
  std::vector<std::unique_ptr<Signal>> signals;
  for (const std::string& body : std::exchange(settings.bodies, {})) {
    settings.bodies = {body};
    signals.push_back(
        std::make_unique<SignalOfNamedBody>(body, make_signal_of_body(settings, model)));
  }
  return std::make_unique<SignalList>(std::move(signals));
}

}  // namespace

std::unique_ptr<Signal> make_signal_of_body(const ResponseSettings& settings, const Model& model) {
  if (settings.bodies.size() > 1) return make_list(settings, model);
  if (settings.along) return make_along(settings, model);
  if (settings.type == ResponseType::deflection && settings.direction == magnitude_direction) {
    return make_resultant(settings, model);
  }
  const std::vector<const BodyModel*> parts = model.parts(settings.bodies.front());
  if (parts.size() > 1) return DividedSignalMaker(settings, model).make();
  return BodySignalMaker(settings, model, *parts.front()).make();
}

}  // namespace pleuel
