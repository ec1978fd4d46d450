#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/mechanism/mechanism.hpp"

namespace pleuel {

/// What a sudden change of the forces does to a mechanism that is frozen at a state: accelerations
/// at once, and vibrations faster than steps can follow about the new equilibrium, as they would be
/// if nothing damped them. These are Ritz vectors of the load (Wilson, Yuan & Dickens 1982): a few
/// solutions find the modes that it excites.
class FastVibration {
 public:
  /// @param behind   positions and velocities, and the instant behind the change
  /// @param change   of the residual at a fixed state, constraints on acceleration level, n + m
  /// @param slowest  angular frequency from which on a mode is fast [rad/s]
  FastVibration(const Mechanism& mechanism, const State& behind, const Eigen::VectorXd& change,
                double slowest);

  /// Whether there is none.
  bool is_empty() const { return modes_.empty(); }
  /// Of the modes that deform: those with a ten-thousandth of the energy do not count [s].
  double shortest_period() const;
  double longest_period() const;
  /// Of the mode with the most energy [s].
  double main_period() const;

  /// Takes a state at the change to a time behind it [s], as far as the fast modes go.
  void add(double time, State& state) const;
  /// Takes a state in which they rest to where they are at a time behind the change.
  void add_swing(double time, State& state) const;

 private:
  struct Mode {
    double frequency = 0.0;        ///< [rad/s]
    double energy = 0.0;           ///< of the way to the equilibrium [J]
    Eigen::VectorXd q, a, lambda;  ///< that way, what it accelerates and holds
  };
  /// @param way, rate  of each mode: share of its q, and its change per time [1/s]
  static void add(const Mode& mode, double way, double rate, State& state);

  Eigen::VectorXd a_, lambda_;  ///< at once
  std::vector<Mode> modes_;
};

}  // namespace pleuel
