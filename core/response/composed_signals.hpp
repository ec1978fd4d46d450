#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/int_size.hpp"
#include "core/frame/body_frame.hpp"
#include "core/response/signal.hpp"
#include "core/scene/response_settings.hpp"
#include "core/system/projected_term.hpp"

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

/// c(x): what a signal is multiplied with, which depends on the design only.
struct DesignFactor {
  double value;
  Eigen::VectorXd derivatives;  ///< one a design variable
  std::string name = "";        ///< goes behind the description of a channel

  DesignFactor inverse() const { return {1.0 / value, -derivatives / (value * value), name}; }
};

/// Of the channels of a signal with several factors.
enum class ScaledOrder {
  factor_by_factor,   ///< all channels with the first factor, all with the second …
  channel_by_channel  ///< the first channel with all factors, the second …
};

/// c(x) · signal: each channel with each of some factors.
class ScaledSignal final : public Signal {
 public:
  ScaledSignal(std::unique_ptr<Signal> inner, std::vector<DesignFactor> factors,
               ScaledOrder order = ScaledOrder::factor_by_factor)
      : inner_(std::move(inner)), factors_(std::move(factors)), values_(inner_->channels()) {
    const bool is_by_factor = order == ScaledOrder::factor_by_factor;
    of_next_factor_ = is_by_factor ? int_size(values_) : 1;
    of_next_value_ = is_by_factor ? 1 : int_size(factors_);
  }

  int channels() const override { return int_size(factors_) * int_size(values_); }
  std::string describe(int channel) const override {
    return inner_->describe(own(channel)) + factor(channel).name;
  }

  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    inner_->observe(state, values_);
    for (int i = 0; i < int_size(factors_); ++i) {
      for (int k = 0; k < int_size(values_); ++k) {
        values(i * of_next_factor_ + k * of_next_value_) = factors_[i].value * values_(k);
      }
    }
  }

  void add_gradient(const State& state, int channel, double weight,
                    SignalGradient& gradient) override {
    const DesignFactor& by = factor(channel);
    inner_->observe(state, values_);
    inner_->add_gradient(state, own(channel), weight * by.value, gradient);
    gradient.design += weight * values_(own(channel)) * by.derivatives;
  }

 private:
  /// The channel of the signal itself.
  int own(int channel) const { return channel / of_next_value_ % int_size(values_); }
  const DesignFactor& factor(int channel) const {
    return factors_[channel / of_next_factor_ % int_size(factors_)];
  }

  std::unique_ptr<Signal> inner_;
  std::vector<DesignFactor> factors_;
  Eigen::VectorXd values_;              ///< scratch
  int of_next_factor_, of_next_value_;  ///< so many channels further
};

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

/// A component (0 … 2) of a vector, or its magnitude √(x² + y² + z² + ε²). ε = 1e-30 in the unit of
/// the vector keeps the root differentiable at zero; its share is below round-off elsewhere.
template <class Scalar>
Scalar component_of(const Vector3<Scalar>& vector, int direction) {
  using std::sqrt;
  if (direction != magnitude_direction) return vector(direction);
  constexpr double epsilon = 1e-30;
  return sqrt(Scalar(vector.dot(vector)) + epsilon * epsilon);
}

/// Its derivatives with respect to the vector.
inline Eigen::RowVector3d component_slope(const Eigen::Vector3d& vector, int direction) {
  if (direction != magnitude_direction) return Eigen::RowVector3d::Unit(direction);
  return vector.transpose() / component_of<double>(vector, magnitude_direction);
}

inline const char* component_name(int direction) {
  switch (direction) {
    case 0:
      return "global x";
    case 1:
      return "global y";
    case 2:
      return "global z";
    default:
      return "magnitude";
  }
}

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

/// A signal that is written in local coordinates q_l = P q of the generalized ones:
///     ∂y/∂q = Pᵀ ∂y/∂q_l,    ∂y/∂x = explicit part + ∂y/∂q_l · P_x q + …
class ProjectedSignal final : public Signal {
 public:
  /// @param variables  number of design variables
  ProjectedSignal(std::unique_ptr<Signal> inner, CoordinateMap map, int variables);

  int channels() const override { return inner_->channels(); }
  std::string describe(int channel) const override { return inner_->describe(channel); }
  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override;
  void add_gradient(const State& state, int channel, double weight,
                    SignalGradient& gradient) override;

 private:
  void scatter(const Eigen::VectorXd& local, Eigen::VectorXd& all) const;

  std::unique_ptr<Signal> inner_;
  CoordinateMap map_;
  LocalState state_;
  SignalGradient local_;
};

}  // namespace pleuel
