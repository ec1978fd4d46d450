#include "core/response/fatigue_signal.hpp"

#include <array>
#include <utility>

#include "core/response/body_strengths.hpp"

namespace pleuel {

namespace {

/// 1/S of a strength S of the material.
struct Inverse {
  double value;
  Eigen::VectorXd derivatives;  ///< one a design variable
};

Inverse inverse_of(const BodyModel& body, int variables, double Strengths<double>::*member) {
  const double strength = strengths_of(body).*member;
  Inverse inverse{1.0 / strength, Eigen::VectorXd::Zero(variables)};
  for (const auto& [variable, change] : strength_derivatives(body)) {
    inverse.derivatives(variable) = -(change.*member) / (strength * strength);
  }
  return inverse;
}

/// Each channel of a stress twice, over one strength and over another.
class StressOverStrengths final : public Signal {
 public:
  StressOverStrengths(std::unique_ptr<Signal> stress, Inverse first, Inverse second)
      : stress_(std::move(stress)),
        inverses_{std::move(first), std::move(second)},
        values_(stress_->channels()) {}

  int channels() const override { return 2 * stress_->channels(); }
  std::string describe(int channel) const override {
    const std::string place = stress_->describe(channel / 2);
    return channel % 2 == 0 ? place : place + ", as a mean stress";
  }

  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    stress_->observe(state, values_);
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      values(i) = inverse(i).value * values_(i / 2);
    }
  }

  void add_gradient(const State& state, int channel, double weight,
                    SignalGradient& gradient) override {
    stress_->observe(state, values_);
    stress_->add_gradient(state, channel / 2, weight * inverse(channel).value, gradient);
    gradient.design += weight * values_(channel / 2) * inverse(channel).derivatives;
  }

 private:
  const Inverse& inverse(Eigen::Index channel) const {
    return inverses_[static_cast<std::size_t>(channel % 2)];
  }

  std::unique_ptr<Signal> stress_;
  std::array<Inverse, 2> inverses_;
  Eigen::VectorXd values_;  ///< scratch
};

}  // namespace

std::unique_ptr<Signal> make_fatigue_signal(std::unique_ptr<Signal> stress, const BodyModel& body,
                                            int variables, const CycleStrengths& strengths) {
  return std::make_unique<StressOverStrengths>(std::move(stress),
                                               inverse_of(body, variables, strengths.of_amplitude),
                                               inverse_of(body, variables, strengths.of_mean));
}

}  // namespace pleuel
