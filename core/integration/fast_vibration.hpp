#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/integration/mechanism.hpp"

namespace pleuel {

/// What a sudden change of the forces does to a mechanism that is frozen at a state: accelerations
/// at once, and vibrations faster than steps can follow about the new equilibrium. These are Ritz
/// vectors of the load (Wilson, Yuan & Dickens 1982): a few solutions find the modes that it
/// excites.
class FastVibration {
 public:
  /// @param behind   positions and velocities, and the instant behind the change
  /// @param change   of the residual at a fixed state, constraints on acceleration level, n + m
  /// @param slowest  angular frequency from which on a mode is fast [rad/s]
  FastVibration(const Mechanism& mechanism, const State& behind, const Eigen::VectorXd& change,
                double slowest);

  /// Whether there is none.
  bool is_empty() const { return modes_.empty(); }
  /// Of the modes that deform: those with the hundredth part of the energy do not count [s].
  double shortest_period() const;
  double longest_period() const;
  /// Of the mode with the most energy [s].
  double main_period() const;

  /// Takes a state at the change to a time behind it [s], as far as the fast modes go.
  void add(double time, State& state) const;
  /// Takes a state in which they rest to where they are at a time behind the change.
  void add_swing(double time, State& state) const;
  /// Takes a state at the change to the new equilibrium of the fast modes.
  void add_settled(State& state) const;

 private:
  struct Mode {
    double frequency = 0.0;                        ///< [rad/s]
    double damping_ratio = 0.0;                    ///< by what resists at the speed of the swing
    double energy = 0.0;                           ///< of the way to the equilibrium [J]
    Eigen::VectorXd q;                             ///< that way
    Eigen::VectorXd a_q, lambda_q, a_v, lambda_v;  ///< what it and its rate accelerate and hold
  };
  /// Way and rate of a mode, as shares of its q.
  struct Swing {
    double way = 0.0, rate = 0.0;
  };
  static Swing swing(const Mode& mode, double time);
  static void add(const Mode& mode, const Swing& swing, State& state);
  void add_at_once(State& state) const;

  Eigen::VectorXd a_, lambda_;  ///< at once
  std::vector<Mode> modes_;
};

}  // namespace pleuel
