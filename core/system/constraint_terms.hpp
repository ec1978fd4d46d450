#pragma once

#include <vector>

#include "core/system/system.hpp"

namespace pleuel {

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
