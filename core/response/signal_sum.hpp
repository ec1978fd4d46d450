#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/response/signal.hpp"

namespace pleuel {

/// Σ factor · signal, of signals with the same channels; described as the first of them.
class SignalSum final : public Signal {
 public:
  struct Part {
    double factor;
    std::unique_ptr<Signal> signal;
  };

  explicit SignalSum(std::vector<Part> parts)
      : parts_(std::move(parts)), values_(parts_.front().signal->channels()) {}

  int channels() const override { return static_cast<int>(values_.size()); }

  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    values.setZero();
    for (Part& part : parts_) {
      part.signal->observe(state, values_);
      values += part.factor * values_;
    }
  }

  void add_gradient(const State& state, int channel, double weight,
                    SignalGradient& gradient) override {
    for (Part& part : parts_) {
      part.signal->add_gradient(state, channel, weight * part.factor, gradient);
    }
  }

  std::string describe(int channel) const override {
    return parts_.front().signal->describe(channel);
  }

 private:
  std::vector<Part> parts_;
  Eigen::VectorXd values_;
};

}  // namespace pleuel
