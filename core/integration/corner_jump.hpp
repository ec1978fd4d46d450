#pragma once

#include <array>
#include <vector>

#include "core/integration/step_equations.hpp"
#include "core/mechanism/linear_solver.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/system/linear_forces.hpp"

namespace pleuel {

/// What jumps of the acceleration and of the jerk where drives prescribe it: with d the jump of Φ̈, and
/// that of dΦ̈/dt, as time alone makes them,
///     M j + Φ_qᵀ μ = 0,   Φ_q j + d = 0
/// A scheme has velocities that are off by c h² q⃛, and an algorithmic acceleration a(t + δ) = a + δ q⃛.
/// Where these go on as they were, accelerations and multipliers of index 3 and of the stabilized index 2
/// zigzag about their values for many steps, as the scheme damps little: by as much as the
/// acceleration jumps, whatever the step, and by O(h) of the jerk. So the step behind such a corner
/// begins with a, v and w as they are with what acts behind it. (It is to the corner what Arnold,
/// Brüls & Cardona 2015 is to the start.) What speeds make of an acceleration that jumps is left out
/// of the jerk. Elastic coordinates that are damped so stiffly that they follow within a step have no jump.
class CornerJump {
 public:
  explicit CornerJump(const Mechanism& mechanism);

  /// Looks for a corner at a state: an equation whose acceleration changes by more than it does
  /// anyway within the step.
  /// @param step  that begins there [s]
  /// @throws SimulationError if the equations are singular
  bool find(const State& state, double step);

  /// Of the acceleration and of the jerk: n entries, or n × columns.
  template <class Columns>
  struct Jumps {
    Columns acceleration, jerk;
  };
  const Jumps<Eigen::VectorXd>& value() const { return jumps_; }

  /// Their derivatives.
  /// @param state  those of q, v and a
  Jumps<Eigen::MatrixXd> differentiate(const StateSensitivity& state, DerivativesOf of);

  /// What derivatives are added to, n × columns each.
  struct Adjoint {
    Columns q, v, a;
    Columns sums;  ///< of parameters (System::add_parameter_adjoints)
  };
  /// The same, transposed.
  /// @param jumps  derivatives with respect to the jumps
  void differentiate_transposed(const Jumps<Eigen::MatrixXd>& jumps, Adjoint adjoint);

 private:
  /// How a jump follows from what is two and one intervals before the corner, and behind it.
  using TimeWeights = std::array<double, 4>;
  TimeWeights weights_of_acceleration() const { return {1.0, -2.0, 2.0, -1.0}; }
  TimeWeights weights_of_jerk() const;
  /// Goes to these times, one after the other.
  template <class Visit>
  void at_each_time(const Visit& visit);
  bool factorize(const std::vector<int>& held);

  Eigen::MatrixXd differentiate(const Eigen::VectorXd& jump, const Eigen::VectorXd& multipliers,
                                const TimeWeights& weights, const StateSensitivity& state,
                                DerivativesOf of);
  void differentiate_transposed(const Eigen::VectorXd& jump, const Eigen::VectorXd& multipliers,
                                const TimeWeights& weights, const Eigen::MatrixXd& jumps,
                                Adjoint adjoint);

  const Mechanism& mechanism_;
  System& system_;
  ConstraintTerms constraints_;
  State state_;
  double interval_ = 0.0;
  std::vector<int> held_;  ///< coordinates without a jump
  LinearForces forces_;
  System::Matrix matrix_, rows_;
  LinearSolver solver_;
  Jumps<Eigen::VectorXd> jumps_, multipliers_;
};

}  // namespace pleuel
