#pragma once

#include <memory>
#include <utility>

#include "core/response/signal.hpp"

namespace pleuel {

/// c(x) · signal, with a factor that depends on the design only.
class ScaledSignal final : public Signal {
 public:
  /// @param factor_x  derivatives of the factor, one a design variable
  ScaledSignal(std::unique_ptr<Signal> inner, double factor, Eigen::VectorXd factor_x)
      : inner_(std::move(inner)),
        factor_(factor),
        factor_x_(std::move(factor_x)),
        values_(inner_->channels()) {}

  int channels() const override { return inner_->channels(); }
  std::string describe(int channel) const override { return inner_->describe(channel); }

  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    inner_->observe(state, values);
    values *= factor_;
  }

  void add_gradient(const State& state, int channel, double weight,
                    SignalGradient& gradient) override {
    inner_->observe(state, values_);
    inner_->add_gradient(state, channel, weight * factor_, gradient);
    gradient.design += weight * values_(channel) * factor_x_;
  }

 private:
  std::unique_ptr<Signal> inner_;
  double factor_;
  Eigen::VectorXd factor_x_;
  Eigen::VectorXd values_;  ///< scratch
};

}  // namespace pleuel
