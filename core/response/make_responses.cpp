#include "core/response/make_responses.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/response/body_frequency.hpp"
#include "core/response/drift_signal.hpp"
#include "core/response/drive_signals.hpp"
#include "core/response/energy_signals.hpp"
#include "core/response/least_norm_signal.hpp"
#include "core/response/projected_signal.hpp"
#include "core/response/reaction_signal.hpp"
#include "core/response/signal_of_body.hpp"
#include "core/scene/response_quantity.hpp"

namespace pleuel {

namespace {

void set_mass(const ResponseSettings& settings, const Model& model, Response& response) {
  response.constant_x = Eigen::VectorXd::Zero(model.mechanism.system->variables());
  for (const BodyModel& body : model.bodies) {
    const bool is_counted = settings.bodies.empty() ||
                            std::find(settings.bodies.begin(), settings.bodies.end(), body.name) !=
                                settings.bodies.end();
    if (!is_counted) continue;
    response.constant += body.mass;
    response.constant_x += body.mass_x;
  }
}

class ResponseMaker {
 public:
  /// @param norm  of the model; null without redundant constraints
  ResponseMaker(const ResponseSettings& settings, const Model& model, const Model& with_all_modes,
                std::shared_ptr<LeastNorm> norm)
      : settings_(settings),
        model_(model),
        with_all_modes_(with_all_modes),
        norm_(std::move(norm)) {}

  Response make() {
    response_.name = settings_.name;
    response_.unit = quantity_of(settings_).unit;
    response_.over_time = settings_.over_time;
    response_.from = settings_.from;
    response_.to = settings_.to;
    switch (settings_.type) {
      case ResponseType::mass:
        set_mass(settings_, model_, response_);
        break;
      case ResponseType::frequency:
        set_frequency();
        break;
      case ResponseType::stress:
      case ResponseType::buckling:
      case ResponseType::deflection:
      case ResponseType::position:
      case ResponseType::velocity:
      case ResponseType::acceleration:
        response_.signal = make_signal_of_body(settings_, model_);
        break;
      case ResponseType::drive_torque:
      case ResponseType::drive_force:
        set_multiplier_signal(make_drive_effort_signal(driven_joint()));
        break;
      case ResponseType::drive_power:
        set_multiplier_signal(make_drive_power_signal(driven_joint()));
        break;
      case ResponseType::reaction_force:
        set_reaction(ReactionPart::Kind::force);
        break;
      case ResponseType::reaction_moment:
        set_reaction(ReactionPart::Kind::moment);
        break;
      case ResponseType::kinetic_energy:
        response_.signal = make_kinetic_energy_signal(model_, settings_.bodies);
        break;
      case ResponseType::elastic_energy:
        response_.signal = make_elastic_energy_signal(model_, settings_.bodies);
        break;
      case ResponseType::energy_balance:
        response_.signal = make_energy_and_power_signal(model_);
        response_.is_balance = true;
        break;
      case ResponseType::constraint_drift:
        if (model_.mechanism.system->multipliers() == 0) fail("the mechanism has no constraints");
        response_.signal = make_drift_signal(model_, settings_.level);
        break;
    }
    return std::move(response_);
  }

 private:
  [[noreturn]] void fail(const std::string& why) const { refuse_response(settings_.name, why); }

  int variables() const { return model_.mechanism.system->variables(); }

  void set_frequency() {
    if (settings_.bodies.empty()) {
      response_.mechanism_mode = settings_.mode;
      return;
    }
    const BodyModel& body = with_all_modes_.body(settings_.bodies.front());
    const FrequencyWithDerivatives frequency = body_frequency(body, settings_.mode, variables());
    response_.constant = frequency.value;
    response_.constant_x = frequency.derivatives;
  }

  const JointModel& driven_joint() const {
    const JointModel& joint = model_.joint(settings_.joint);
    if (joint.drive_row < 0) fail(fmt::format("the joint \"{}\" has no drive", joint.name));
    return joint;
  }

  void set_reaction(ReactionPart::Kind kind) {
    const JointModel& joint = model_.joint(settings_.joint);
    auto signal = make_reaction_signal(joint, {kind, settings_.direction});
    if (joint.map) {
      signal = std::make_unique<ProjectedSignal>(std::move(signal), *joint.map, variables());
    }
    set_multiplier_signal(std::move(signal));
  }

  /// Where constraints are redundant, multipliers are those of least norm.
  void set_multiplier_signal(std::unique_ptr<Signal> signal) {
    if (norm_) {
      response_.signal = std::make_unique<LeastNormSignal>(std::move(signal), norm_, model_);
    } else {
      response_.signal = std::move(signal);
    }
  }

  const ResponseSettings& settings_;
  const Model& model_;
  const Model& with_all_modes_;
  std::shared_ptr<LeastNorm> norm_;
  Response response_;
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
  std::vector<Response> responses;
  for (const ResponseSettings& setting : settings) {
    responses.push_back(ResponseMaker(setting, model, with_all_modes, norm).make());
  }
  return responses;
}

}  // namespace pleuel
