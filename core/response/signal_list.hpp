#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/response/signal.hpp"

namespace pleuel {

/// The channels of several signals one after the other.
class SignalList final : public Signal {
 public:
  explicit SignalList(std::vector<std::unique_ptr<Signal>> signals) : signals_(std::move(signals)) {
    for (const auto& signal : signals_) channels_ += signal->channels();
  }

  int channels() const override { return channels_; }

  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    Eigen::Index first = 0;
    for (const auto& signal : signals_) {
      signal->observe(state, values.segment(first, signal->channels()));
      first += signal->channels();
    }
  }

  void add_gradient(const State& state, int channel, double weight,
                    SignalGradient& gradient) override {
    const auto [signal, own] = find(channel);
    signal->add_gradient(state, own, weight, gradient);
  }

  std::string describe(int channel) const override {
    const auto [signal, own] = find(channel);
    return signal->describe(own);
  }

 private:
  std::pair<Signal*, int> find(int channel) const {
    std::size_t i = 0;
    while (channel >= signals_[i]->channels()) channel -= signals_[i++]->channels();
    return {signals_[i].get(), channel};
  }

  std::vector<std::unique_ptr<Signal>> signals_;
  int channels_ = 0;
};

}  // namespace pleuel
