#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/int_size.hpp"
#include "core/response/signal.hpp"

namespace pleuel {

/// Σ factor · signal, of signals with the same channels; described as the first of them, or by a
/// name.
class SignalSum final : public Signal {
 public:
  struct Part {
    double factor;
    std::unique_ptr<Signal> signal;
  };

  explicit SignalSum(std::vector<Part> parts, std::string name = "")
      : parts_(std::move(parts)), name_(std::move(name)), own_(parts_.front().signal->channels()) {}

  int channels() const override { return int_size(own_); }

  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    values.setZero();
    for (Part& part : parts_) {
      part.signal->observe(state, own_);
      values += part.factor * own_;
    }
  }

  void add_gradient(const State& state, int channel, double weight,
                    SignalGradient& gradient) override {
    for (Part& part : parts_) {
      part.signal->add_gradient(state, channel, weight * part.factor, gradient);
    }
  }

  std::string describe(int channel) const override {
    return name_.empty() ? parts_.front().signal->describe(channel) : name_;
  }

 private:
  std::vector<Part> parts_;
  std::string name_;
  Eigen::VectorXd own_;  ///< of one part
};

}  // namespace pleuel
