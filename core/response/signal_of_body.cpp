#include "core/response/signal_of_body.hpp"

#include <fmt/format.h>

#include "core/response/buckling_signal.hpp"
#include "core/response/imported_signals.hpp"
#include "core/response/imported_stress_signal.hpp"
#include "core/response/motion_signals.hpp"
#include "core/response/projected_signal.hpp"
#include "core/response/response.hpp"
#include "core/response/stress_signal.hpp"

namespace pleuel {

namespace {

class BodySignalMaker {
 public:
  BodySignalMaker(const ResponseSettings& settings, const Model& model)
      : settings_(settings), model_(model), body_(model.body(settings.bodies.front())) {}

  std::unique_ptr<Signal> make() const {
    const bool needs_section_forces =
        settings_.type == ResponseType::stress || settings_.type == ResponseType::buckling;
    if (needs_section_forces && body_.is_beam()) check_section_forces();
    if (body_.is_imported()) return make_imported_signal();
    if (!body_.basis) return make_body_signal(body_);
    return std::make_unique<ProjectedSignal>(make_body_signal(*body_.nodal), body_.map,
                                             model_.mechanism.system->variables());
  }

 private:
  [[noreturn]] void fail(const std::string& why) const { refuse_response(settings_.name, why); }

  /// Section forces come from strain.
  void check_section_forces() const {
    if (!body_.is_elastic) fail(fmt::format("\"{}\" is rigid", body_.name));
    const bool needs_axial =
        settings_.type == ResponseType::buckling || settings_.part == StressPart::axial;
    if (needs_axial && !has_displacement(0)) {
      fail(fmt::format("\"{}\" has no axial elasticity", body_.name));
    }
    const bool needs_twist = settings_.part == StressPart::shear &&
                             body_.frame.rotation == RotationCoordinates::rotation_vector;
    if (needs_twist && !has_displacement(3)) {
      fail(fmt::format("\"{}\" has no torsional elasticity", body_.name));
    }
    const bool has_strength = body_.beam.elements.front().strength > 0.0;
    if (settings_.part == StressPart::utilization && !has_strength) {
      fail(fmt::format("the material of \"{}\" has no strength", body_.name));
    }
  }

  bool has_displacement(int direction) const {
    const ElasticCoordinates& coordinates = *body_.coordinates;
    for (int node = 0; node < coordinates.node_count(); ++node) {
      if (coordinates.index(node, direction) >= 0) return true;
    }
    return false;
  }

  /// @param body  the one itself, or with a basis the one in the coordinates of its elements
  std::unique_ptr<Signal> make_body_signal(const BodyModel& body) const {
    const PlaceMotion place{settings_.at, settings_.direction};
    switch (settings_.type) {
      case ResponseType::stress:
        return make_stress_signal(body, model_.gravity, settings_.part,
                                  {settings_.segment, settings_.station});
      case ResponseType::buckling:
        return make_buckling_signal(body, model_.gravity);
      case ResponseType::deflection:
        return make_deflection(body);
      case ResponseType::position:
        return make_position_signal(body, place);
      case ResponseType::velocity:
        return make_velocity_signal(body, place);
      default:
        return make_acceleration_signal(body, place);
    }
  }

  std::unique_ptr<Signal> make_imported_signal() const {
    const bool needs_strain =
        settings_.type == ResponseType::stress || (settings_.type == ResponseType::deflection &&
                                                   settings_.against == DeflectionReference::frame);
    if (needs_strain && !body_.is_elastic) fail(fmt::format("\"{}\" is rigid", body_.name));
    const auto motion = [&](TimeDerivative derivative) {
      return make_imported_motion_signal(body_, settings_.place, settings_.direction, derivative);
    };
    switch (settings_.type) {
      case ResponseType::stress:
        return make_imported_stress_signal(body_, model_.gravity, settings_.part);
      case ResponseType::velocity:
        return motion(TimeDerivative::first);
      case ResponseType::acceleration:
        return motion(TimeDerivative::second);
      case ResponseType::deflection:
        if (settings_.against == DeflectionReference::frame) {
          return make_imported_deflection_signal(body_, settings_.place, settings_.direction);
        }
        [[fallthrough]];
      default:  // also against the rigid mechanism, see make_deflection()
        return motion(TimeDerivative::none);
    }
  }

  std::unique_ptr<Signal> make_deflection(const BodyModel& body) const {
    switch (settings_.against) {
      case DeflectionReference::frame:
        return make_deflection_signal(body, settings_.at, settings_.direction);
      case DeflectionReference::chord:
        return make_chord_deflection_signal(body, settings_.at, settings_.direction);
      default:  // the position in the rigid mechanism is taken off afterwards
        return make_position_signal(body, {settings_.at, settings_.direction});
    }
  }

  const ResponseSettings& settings_;
  const Model& model_;
  const BodyModel& body_;
};

}  // namespace

std::unique_ptr<Signal> make_signal_of_body(const ResponseSettings& settings, const Model& model) {
  return BodySignalMaker(settings, model).make();
}

}  // namespace pleuel
