#pragma once

#include "core/system/term.hpp"

namespace pleuel {

/// What can be read of a force element.
enum class Reading {
  coordinate,   ///< its length or relative coordinate [m] or [rad]
  rate,         ///< of that
  force,        ///< of its spring and damper: a pull, or on the second body [N] or [N m]
  motor_power,  ///< what its motor supplies [W]
  damper_power  ///< what its damper takes, and its resistance to a rate [W]
};

/// Reads a force element in a state, with derivatives. It acts on nothing.
class Gauge {
 public:
  virtual ~Gauge() = default;
  virtual double read(const State& state, Reading reading) const = 0;
  /// q += weight · ∂(reading)/∂q; v and design alike.
  virtual void add_gradient(const State& state, Reading reading, double weight, Eigen::VectorXd& q,
                            Eigen::VectorXd& v, Eigen::VectorXd& design) const = 0;
};

}  // namespace pleuel
