#include "core/response/gauge_signal.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/response/projected_signal.hpp"
#include "core/response/response.hpp"
#include "core/scene/response_kind.hpp"
#include "core/system/gauge.hpp"

namespace pleuel {

namespace {

class GaugeSignal final : public Signal {
 public:
  GaugeSignal(std::shared_ptr<const Gauge> gauge, Reading reading, std::string name)
      : gauge_(std::move(gauge)), reading_(reading), name_(std::move(name)) {}

  int channels() const override { return 1; }
  std::string describe(int) const override { return name_; }
  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    values(0) = gauge_->read(state, reading_);
  }
  void add_gradient(const State& state, int, double weight, SignalGradient& gradient) override {
    gauge_->add_gradient(state, reading_, weight, gradient.q, gradient.v, gradient.design);
  }

 private:
  std::shared_ptr<const Gauge> gauge_;
  Reading reading_;
  std::string name_;
};

Reading reading_of(ResponseType type) {
  switch (type) {
    case ResponseType::joint_velocity:
      return Reading::rate;
    case ResponseType::spring_force:
      return Reading::force;
    case ResponseType::motor_power:
      return Reading::motor_power;
    case ResponseType::damper_power:
      return Reading::damper_power;
    default:
      return Reading::coordinate;
  }
}

const std::optional<GaugeModel>& find_gauge(const ResponseSettings& settings, const Model& model) {
  if (!settings.joint.empty()) {
    const JointModel& joint = model.joint(settings.joint);
    return settings.coordinate == DrivenCoordinate::angle ? joint.angle : joint.displacement;
  }
  return std::find_if(model.loads.begin(), model.loads.end(),
                      [&](const LoadModel& load) { return load.name == settings.load; })
      ->gauge;
}

}  // namespace

std::unique_ptr<Signal> make_gauge_signal(const ResponseSettings& settings, const Model& model) {
  const std::string name = settings.joint.empty() ? settings.load : settings.joint;
  const std::optional<GaugeModel>& found = find_gauge(settings, model);
  if (!found) {
    refuse_response(settings.name, fmt::format("\"{}\" has no such relative coordinate: one of its "
                                               "bodies is a point that does not turn",
                                               name));
  }
  auto signal =
      std::make_unique<GaugeSignal>(found->gauge, reading_of(observed_type(settings.type)), name);
  if (!found->map) return signal;
  return std::make_unique<ProjectedSignal>(std::move(signal), *found->map,
                                           model.mechanism.system->variables());
}

}  // namespace pleuel
