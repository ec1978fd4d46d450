#include "core/response/make_responses.hpp"

#include <algorithm>
#include <map>
#include <memory>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/body_frequency.hpp"
#include "core/response/body_strengths.hpp"
#include "core/response/composed_signals.hpp"
#include "core/response/energy_signals.hpp"
#include "core/response/force_signals.hpp"
#include "core/response/history_map.hpp"
#include "core/response/motion_signals.hpp"
#include "core/response/signal_of_body.hpp"
#include "core/scene/response_kind.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {

namespace {

DesignConstant mass_of(const ResponseSettings& settings, const Model& model) {
  DesignConstant mass{0.0, Eigen::VectorXd::Zero(model.mechanism.system->variables())};
  for (const BodyModel& body : model.bodies) {
    const bool is_counted = settings.bodies.empty() ||
                            std::ranges::find(settings.bodies, body.name) != settings.bodies.end();
    if (!is_counted) continue;
    mass.value += body.mass;
    mass.derivatives += body.mass_x;
  }
  return mass;
}

/// By what they observe.
using Signals = std::map<ResponseSettings, std::shared_ptr<Signal>>;

/// Without what does not change what is observed. Averages of some are of other places than peaks.
ResponseSettings observed_by(ResponseSettings settings) {
  settings.name.clear();
  settings.from = settings.to = std::nullopt;
  settings.unit.clear();
  settings.unit_scale = 1.0;
  return settings;
}

class ResponseMaker {
 public:
  /// @param norm     of the model; null without redundant constraints
  /// @param signals  what is observed already
  ResponseMaker(const ResponseSettings& settings, const Model& model, const Model& with_all_modes,
                std::shared_ptr<LeastNorm> norm, Signals& signals)
      : settings_(settings),
        model_(model),
        with_all_modes_(with_all_modes),
        norm_(std::move(norm)),
        signals_(signals) {}

  Response make() {
    Response response{settings_.name, std::string(quantity_of(settings_).unit), {}};
    if (settings_.type == ResponseType::mass) {
      response.source = mass_of(settings_, model_);
    } else if (settings_.type == ResponseType::expression) {
      response.source = ResponseExpression{settings_.expression};
    } else if (!is_of_modes(settings_.type)) {
      response.source = history();
    } else if (settings_.bodies.empty()) {
      response.source = InitialMode{settings_.mode};
    } else {
      response.source = frequency_of_body();
    }
    return response;
  }

 private:
  [[noreturn]] void fail(const std::string& why) const { refuse_response(settings_.name, why); }

  int variables() const { return model_.mechanism.system->variables(); }

  ResponseHistory history() {
    std::shared_ptr<Signal>& signal = signals_[observed_by(settings_)];
    if (!signal) signal = make_signal();
    ResponseHistory history{signal, settings_.over_time, settings_.from, settings_.to};
    if (settings_.type == ResponseType::energy_balance) {
      history.map = std::make_unique<BalanceMap>();
    }
    if (kind_of(settings_.type).rate_of) history.map = std::make_unique<RateMap>();
    // Both sides of a load: a force is not larger because it points the other way.
    if (settings_.type == ResponseType::section_force) {
      history.among = AmongChannels::largest_magnitude;
    }
    if (settings_.type == ResponseType::fatigue) history.fatigue = {settings_.criterion};
    if (settings_.type == ResponseType::fatigue_damage) {
      const BodyModel& body = *model_.parts(settings_.bodies.front()).front();
      history.fatigue = {settings_.criterion, strengths_of(body).fatigue_exponent};
    }
    return history;
  }

  std::unique_ptr<Signal> make_signal() {
    switch (observed_type(settings_.type)) {
      case ResponseType::drive_torque:
      case ResponseType::drive_force:
        return of_multipliers(make_drive_signal(driven_joint(), DriveNumber::effort));
      case ResponseType::drive_power:
        return of_multipliers(make_drive_signal(driven_joint(), DriveNumber::power));
      case ResponseType::reaction_force:
        return make_reaction(ReactionPart::Kind::force);
      case ResponseType::reaction_moment:
        return make_reaction(ReactionPart::Kind::moment);
      case ResponseType::kinetic_energy:
        return make_kinetic_energy_signal(model_, settings_.bodies);
      case ResponseType::elastic_energy:
        return make_elastic_energy_signal(model_, settings_.bodies);
      case ResponseType::energy_balance:
        return make_energy_and_power_signal(model_);
      case ResponseType::constraint_drift:
        if (model_.mechanism.system->multipliers() == 0) fail("the mechanism has no constraints");
        return make_drift_signal(model_, settings_.level);
      case ResponseType::transmission_angle:
        return make_transmission();
      case ResponseType::joint_position:
      case ResponseType::joint_velocity:
      case ResponseType::spring_length:
      case ResponseType::spring_force:
      case ResponseType::motor_power:
      case ResponseType::damper_power:
        return make_reading();
      default:
        return make_signal_of_body(settings_, model_);
    }
  }

  std::unique_ptr<Signal> make_transmission() const {
    const BodyModel& body = *model_.parts(settings_.bodies.front()).front();
    if (settings_.along) {
      return make_transmission_angle(
          body, Eigen::Map<const Eigen::Vector3d>(settings_.along->data()).eval());
    }
    return make_transmission_angle(body, *model_.parts(settings_.bodies.back()).front());
  }

  std::unique_ptr<Signal> make_reading() const { return make_gauge_signal(settings_, model_); }

  DesignConstant frequency_of_body() const {
    const BodyModel& body = with_all_modes_.body(settings_.bodies.front());
    try {
      return body_frequency(body, settings_.mode, variables());
    } catch (const InputError& error) {
      fail(error.what());
    }
  }

  const JointModel& driven_joint() const {
    const JointModel& joint = model_.joint(settings_.joint);
    if (joint.drive_row < 0) fail(fmt::format("the joint \"{}\" has no drive", joint.name));
    return joint;
  }

  std::unique_ptr<Signal> make_reaction(ReactionPart::Kind kind) const {
    const JointModel& joint = model_.joint(settings_.joint);
    auto signal = make_reaction_signal(joint, {kind, settings_.direction});
    if (joint.map) {
      signal = std::make_unique<ProjectedSignal>(std::move(signal), *joint.map, variables());
    }
    return of_multipliers(std::move(signal));
  }

  /// Where constraints are redundant, multipliers are those of least norm.
  std::unique_ptr<Signal> of_multipliers(std::unique_ptr<Signal> signal) const {
    if (!norm_) return signal;
    return std::make_unique<LeastNormSignal>(std::move(signal), norm_, model_);
  }

  const ResponseSettings& settings_;
  const Model& model_;
  const Model& with_all_modes_;
  std::shared_ptr<LeastNorm> norm_;
  Signals& signals_;
};

}  // namespace

std::vector<Response> make_responses(const std::vector<ResponseSettings>& settings,
                                     const Model& model) {
  return make_responses(settings, model, model);
}

std::vector<Response> make_responses(const std::vector<ResponseSettings>& settings,
                                     const Model& model, const Model& with_all_modes) {
  std::shared_ptr<LeastNorm> norm;
  if (!model.mechanism.system->left_out().empty()) {
    norm = std::make_shared<LeastNorm>(model.mechanism);
  }
  Signals signals;
  std::vector<Response> responses;
  std::size_t against_rigid = 0;  // the rigid mechanism has these only, in this order
  for (const ResponseSettings& setting : settings) {
    responses.push_back(ResponseMaker(setting, model, with_all_modes, norm, signals).make());
    if (setting.against == DeflectionReference::rigid_mechanism) {
      std::get<ResponseHistory>(responses.back().source).rigid_response = against_rigid++;
    }
  }
  return responses;
}

}  // namespace pleuel
