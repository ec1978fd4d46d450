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
#include "core/scene/shown_unit.hpp"

namespace pleuel {

namespace {

DesignConstant mass_of(const MassResponse& mass, const Model& model) {
  DesignConstant sum{0.0, Eigen::VectorXd::Zero(model.mechanism.system->variables())};
  for (const BodyModel& body : model.bodies) {
    const bool is_counted =
        mass.bodies.empty() || std::ranges::find(mass.bodies, body.name) != mass.bodies.end();
    if (!is_counted) continue;
    sum.value += body.mass;
    sum.derivatives += body.mass_x;
  }
  return sum;
}

/// Whether the signal shows what changes, and not its rate, which is asked for.
bool is_rate(const ResponseSettings& settings) {
  const TimeDerivative least =
      settings.is<JointMotionResponse>() ? TimeDerivative::second : TimeDerivative::third;
  return time_derivative_of(settings) >= least;
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

  Response make() const {
    Response response{settings_.name, std::string(quantity_of(settings_).unit), {}};
    std::visit([&](const auto& one) { response.source = source(one); }, settings_.what);
    return response;
  }

 private:
  [[noreturn]] void fail(const std::string& why) const { refuse_response(settings_.name, why); }

  int variables() const { return model_.mechanism.system->variables(); }

  using Source = decltype(Response::source);

  Source source(const MassResponse& mass) const { return mass_of(mass, model_); }
  Source source(const ExpressionResponse& expression) const { return expression; }
  Source source(const ModeResponse& mode) const {
    if (mode.body.empty()) return mode.mode;
    return frequency_of_body(mode);
  }
  template <class Other>
  Source source(const Other& other) const {
    std::shared_ptr<Signal>& signal = signals_[observed_by(settings_)];
    if (!signal) signal = make_signal(other);
    return history(signal);
  }

  ResponseHistory history(std::shared_ptr<Signal> signal) const {
    ResponseHistory history{std::move(signal), settings_.over_time, settings_.from, settings_.to};
    if (settings_.is<EnergyBalanceResponse>()) history.map = std::make_unique<BalanceMap>();
    if (is_rate(settings_)) history.map = std::make_unique<RateMap>();
    // Both sides of a load: a force is not larger because it points the other way.
    if (settings_.is<SectionForceResponse>()) history.among = AmongChannels::largest_magnitude;
    if (const auto* fatigue = settings_.as<FatigueResponse>()) history.fatigue = rule_of(*fatigue);
    return history;
  }

  FatigueRule rule_of(const FatigueResponse& fatigue) const {
    if (fatigue.kind == FatigueNumber::utilization) return {fatigue.criterion};
    const BodyModel& body = *model_.parts(fatigue.where.bodies.front()).front();
    return {fatigue.criterion, strengths_of(body).fatigue_exponent};
  }

  template <class Other>
  std::unique_ptr<Signal> make_signal(const Other&) const {
    return make_signal_of_body(settings_, model_);
  }

  std::unique_ptr<Signal> make_signal(const DriveResponse& drive) const {
    const JointModel& joint = model_.joint(drive.joint);
    if (joint.drive_row < 0) fail(fmt::format("the joint \"{}\" has no drive", joint.name));
    return of_multipliers(make_drive_signal(joint, drive.kind));
  }

  std::unique_ptr<Signal> make_signal(const ReactionResponse& reaction) const {
    const JointModel& joint = model_.joint(reaction.joint);
    auto signal = make_reaction_signal(joint, reaction);
    if (joint.map) {
      signal = std::make_unique<ProjectedSignal>(std::move(signal), *joint.map, variables());
    }
    return of_multipliers(std::move(signal));
  }

  std::unique_ptr<Signal> make_signal(const EnergyResponse& energy) const {
    const auto make = energy.kind == EnergyKind::kinetic ? make_kinetic_energy_signal
                                                         : make_elastic_energy_signal;
    return make(model_, bodies_of(settings_));
  }

  std::unique_ptr<Signal> make_signal(const EnergyBalanceResponse&) const {
    return make_energy_and_power_signal(model_);
  }

  std::unique_ptr<Signal> make_signal(const DriftResponse& drift) const {
    if (model_.mechanism.system->multipliers() == 0) fail("the mechanism has no constraints");
    return make_drift_signal(model_, drift.level);
  }

  std::unique_ptr<Signal> make_signal(const TransmissionAngleResponse& angle) const {
    const BodyModel& body = *model_.parts(angle.bodies.front()).front();
    if (angle.guide) {
      return make_transmission_angle(body,
                                     Eigen::Map<const Eigen::Vector3d>(angle.guide->data()).eval());
    }
    return make_transmission_angle(body, *model_.parts(angle.bodies.back()).front());
  }

  std::unique_ptr<Signal> make_signal(const JointMotionResponse& motion) const {
    return make_gauge_signal(settings_.name, motion, model_);
  }

  std::unique_ptr<Signal> make_signal(const LoadResponse& load) const {
    return make_gauge_signal(settings_.name, load, model_);
  }

  DesignConstant frequency_of_body(const ModeResponse& mode) const {
    try {
      return body_frequency(with_all_modes_.body(mode.body), mode.mode, variables());
    } catch (const InputError& error) {
      fail(error.what());
    }
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
    if (is_against_rigid_mechanism(setting)) {
      std::get<ResponseHistory>(responses.back().source).rigid_response = against_rigid++;
    }
  }
  return responses;
}

}  // namespace pleuel
