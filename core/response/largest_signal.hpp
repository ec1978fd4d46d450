#pragma once

#include <memory>
#include <string>
#include <utility>

#include "core/response/signal.hpp"

namespace pleuel {

/// The largest channel of a signal at each instant. Where two tie it has a kink.
class LargestSignal final : public Signal {
 public:
  /// @param name  for people
  LargestSignal(std::unique_ptr<Signal> inner, std::string name)
      : inner_(std::move(inner)), name_(std::move(name)), values_(inner_->channels()) {}

  int channels() const override { return 1; }
  std::string describe(int) const override { return name_; }

  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    inner_->observe(state, values_);
    values(0) = values_.maxCoeff();
  }

  void add_gradient(const State& state, int, double weight, SignalGradient& gradient) override {
    inner_->observe(state, values_);
    Eigen::Index largest = 0;
    values_.maxCoeff(&largest);
    inner_->add_gradient(state, static_cast<int>(largest), weight, gradient);
  }

 private:
  std::unique_ptr<Signal> inner_;
  std::string name_;
  Eigen::VectorXd values_;  ///< of all channels
};

}  // namespace pleuel
