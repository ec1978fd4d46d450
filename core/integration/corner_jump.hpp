#pragma once

#include <array>

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
/// Brüls & Cardona 2015 is to the start.) What speeds make of an acceleration that jumps is left out of the jerk.
class CornerJump {
 public:
  explicit CornerJump(const Mechanism& mechanism);

  /// Looks for a corner at a state. What is small beside the jerk on both sides is none.
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
  /// @param q  those of the position, n × columns
  Jumps<Eigen::MatrixXd> differentiate(const Eigen::MatrixXd& q, DerivativesOf of);

  /// The same, transposed.
  /// @param jumps  derivatives with respect to the jumps
  /// @param q      += those with respect to the position
  /// @param sums   += those of parameters (System::add_parameter_adjoints)
  void differentiate_transposed(const Jumps<Eigen::MatrixXd>& jumps, Columns q, Columns sums);

 private:
  /// How a jump follows from what is two and one intervals before the corner, and behind it.
  using Weights = std::array<double, 4>;
  Weights weights_of_acceleration() const { return {1.0, -2.0, 2.0, -1.0}; }
  Weights weights_of_jerk() const;
  /// The state at these times.
  template <class Add>
  void for_each_part(const Weights& weights, const Add& add) const;

  Eigen::MatrixXd differentiate(const Eigen::VectorXd& jump, const Eigen::VectorXd& multipliers,
                                const Weights& weights, const Eigen::MatrixXd& q, DerivativesOf of);
  void differentiate_transposed(const Eigen::VectorXd& jump, const Eigen::VectorXd& multipliers,
                                const Weights& weights, const Eigen::MatrixXd& adjoint, Columns q,
                                Columns sums);

  System& system_;
  State state_;
  double interval_ = 0.0;
  LinearForces forces_;
  System::Matrix matrix_, forces_q_;
  LinearSolver solver_;
  Jumps<Eigen::VectorXd> jumps_, multipliers_;
};

}  // namespace pleuel
