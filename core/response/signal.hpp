#pragma once

#include <Eigen/Core>

#include "core/system/term.hpp"

namespace pleuel {

/// ∂y/∂(state) and ∂y/∂x of one number at one instant.
struct SignalGradient {
  Eigen::VectorXd q, v, a, lambda;  ///< as in State
  Eigen::VectorXd design;           ///< explicit part, one entry a design variable

  SignalGradient(int coordinates, int multipliers, int variables)
      : q(Eigen::VectorXd::Zero(coordinates)),
        v(Eigen::VectorXd::Zero(coordinates)),
        a(Eigen::VectorXd::Zero(coordinates)),
        lambda(Eigen::VectorXd::Zero(multipliers)),
        design(Eigen::VectorXd::Zero(variables)) {}

  void set_zero() {
    for (auto* part : {&q, &v, &a, &lambda, &design}) part->setZero();
  }
};

/// Something that is observed at every instant: one or several numbers (channels), each a smooth
/// function of state and design.
class Signal {
 public:
  virtual ~Signal() = default;
  virtual int channels() const = 0;
  /// Writes all channels at a state.
  virtual void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) = 0;
  /// gradient += weight · ∂(channel)/∂(…)
  virtual void add_gradient(const State& state, int channel, double weight,
                            SignalGradient& gradient) = 0;
  /// Where a channel is, for people: "element 3, end 1, y = −0.015 m".
  virtual std::string describe(int channel) const = 0;
  /// Whether the equations of motion determine it: not of a reaction that joints share in more than
  /// one way.
  virtual bool is_determined(const State& /*state*/) { return true; }
};

}  // namespace pleuel
