#pragma once

#include <vector>

#include "core/system/system.hpp"

namespace pleuel {

/// What of the equations of motion is linear in accelerations and multipliers, at a position and a
/// time:
///     F(q, t; a, λ) = R(q, 0, a, λ, t) − R(q, 0, 0, 0, t) = [ M a + Φ_qᵀ λ ; Φ_q a or 0 ]  (n + m)
/// with Φ_q a on the acceleration level of constraints, zero on the others. Rows of constraints
/// that are left out say λ_i.
class LinearForces {
 public:
  explicit LinearForces(System& system, ConstraintLevel level = ConstraintLevel::position);

  /// Goes to time and position of a state, with these a and λ. Nothing else of the state matters.
  void set(const State& place, const Eigen::VectorXd& a, const Eigen::VectorXd& lambda);
  /// With a = 0: forces of constraints.
  void set(const State& place, const Eigen::VectorXd& lambda);

  /// F, n + m entries; valid until the next call.
  const Eigen::VectorXd& residual();

  /// [ F_q, F_λ ] into a matrix from System::make_matrix().
  void tangent(System::Matrix& matrix);

  /// ∂F/∂x at fixed q, a and λ, (n + m) × variables; valid until the next call.
  const Eigen::MatrixXd& design_derivative();

  /// sums += those of μᵀ ∂F/∂x (System::add_parameter_adjoints); μ is (n + m) × any number.
  void add_parameter_adjoints(const ConstColumns& mu, Columns sums);

 private:
  System& system_;
  ConstraintLevel level_;
  State with_, without_;  ///< at rest, with a and λ and without them
  Eigen::VectorXd residual_, residual_without_;
  System::Matrix tangent_without_;
  Eigen::MatrixXd columns_, columns_without_, minus_mu_;
};

/// The terms of a system that have equations of constraints: joints, of which there are few, and
/// which cost little beside bodies. Where only Φ and Φ_qᵀ λ are asked for, they stand for the whole
/// system:
///     R = [ Φ_qᵀ λ ;  Φ(q, t) at the given level ]                                       (n + m)
/// Shapes are those of System; rows of constraints that are left out are zero.
class ConstraintTerms {
 public:
  /// @param system  must outlive this
  explicit ConstraintTerms(const System& system);

  void residual(const State& state, ConstraintLevel level, Eigen::VectorXd& residual);

  /// As System::tangent(), with ones on the diagonal of what is left out.
  void tangent(const State& state, const Weights& weights, ConstraintLevel level,
               System::Matrix& matrix);

  void design_derivative(const State& state, ConstraintLevel level, Eigen::MatrixXd& columns);

  /// sums += those of μᵀ ∂R/∂x (System::add_parameter_adjoints).
  /// @pre the rows of μ that belong to what is left out are zero
  void add_parameter_adjoints(const State& state, ConstraintLevel level, const ConstColumns& mu,
                              Columns sums);

 private:
  struct Part {
    Term* term;
    std::size_t first_entry;
    Eigen::Index first_sum, sums;  ///< of the parameter adjoints of the system
  };

  const System& system_;
  std::vector<Part> parts_;
  std::vector<int> slots_;       ///< of each entry: which value of a matrix; −1: left out
  std::vector<int> ones_;        ///< values on the diagonal of what is left out
  std::vector<double> entries_;  ///< scratch
  Eigen::VectorXd unused_;       ///< scratch
};

}  // namespace pleuel
