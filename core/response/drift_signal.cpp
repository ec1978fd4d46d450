#include "core/response/drift_signal.hpp"

#include <fmt/format.h>

#include "core/model/body_energy.hpp"
#include "core/response/term_product.hpp"

namespace pleuel {

namespace {

class DriftSignal final : public Signal {
 public:
  DriftSignal(const Model& model, ConstraintLevel level)
      : model_(model),
        level_(level),
        terms_(terms_besides_bodies(model).acting, *model.mechanism.system),
        rows_(Eigen::VectorXd::Zero(model.mechanism.system->size())) {}

  int channels() const override { return model_.mechanism.system->multipliers(); }

  std::string describe(int channel) const override {
    for (const JointModel& joint : model_.joints) {
      const int equation = channel - joint.first_multiplier;
      if (equation < 0 || equation >= joint.equations()) continue;
      return fmt::format("joint {}, equation {}", joint.name, equation + 1);
    }
    return fmt::format("equation {}", channel + 1);
  }

  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    values = terms_.residual(state, level_).tail(channels());
  }

  void add_gradient(const State& state, int channel, double weight,
                    SignalGradient& gradient) override {
    const auto row = state.q.size() + channel;
    rows_(row) = weight;
    terms_.add_gradient(state, level_, rows_, gradient);
    rows_(row) = 0.0;
  }

 private:
  const Model& model_;
  ConstraintLevel level_;
  TermProduct terms_;
  Eigen::VectorXd rows_;  ///< zero between calls
};

}  // namespace

std::unique_ptr<Signal> make_drift_signal(const Model& model, DriftLevel level) {
  return std::make_unique<DriftSignal>(
      model, level == DriftLevel::position ? ConstraintLevel::position : ConstraintLevel::velocity);
}

}  // namespace pleuel
