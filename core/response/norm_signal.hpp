#pragma once

#include <array>
#include <memory>
#include <string>
#include <utility>

#include "core/response/signal.hpp"
#include "core/response/vector_component.hpp"

namespace pleuel {

/// √(y₁² + y₂² + ε²) of two signals with one channel each (ε: component_of()).
class NormSignal final : public Signal {
 public:
  NormSignal(std::unique_ptr<Signal> first, std::unique_ptr<Signal> second)
      : parts_{std::move(first), std::move(second)} {}

  int channels() const override { return 1; }
  std::string describe(int) const override { return parts_[0]->describe(0); }
  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    values(0) = component_of<double>(observed(state), magnitude_direction);
  }
  void add_gradient(const State& state, int, double weight, SignalGradient& gradient) override {
    const Eigen::RowVector3d slope = component_slope(observed(state), magnitude_direction);
    for (Eigen::Index i = 0; i < 2; ++i) {
      parts_[i]->add_gradient(state, 0, weight * slope(i), gradient);
    }
  }

 private:
  Eigen::Vector3d observed(const State& state) {
    Eigen::Vector3d values = Eigen::Vector3d::Zero();
    for (Eigen::Index i = 0; i < 2; ++i) {
      parts_[i]->observe(state, values.segment(i, 1));
    }
    return values;
  }

  std::array<std::unique_ptr<Signal>, 2> parts_;
};

}  // namespace pleuel
