#pragma once

#include <vector>

#include "core/base/time_integration.hpp"
#include "core/system/system.hpp"

namespace pleuel {

/// The system with its constraints as a formulation asks for them, Φ^(k) + Σ c_j Φ^(j) = 0: on
/// position level (index 3), on velocity level (stabilized index 2), or on acceleration level with
/// the terms of Baumgarte (1972), Φ̈ + 2b Φ̇ + b² Φ (index 1).
class FormulatedSystem {
 public:
  FormulatedSystem(System& system, const Formulation& formulation);

  /// k, which has factor one.
  ConstraintLevel level() const { return level_; }

  /// n + m entries; valid until the next call, like all that is returned here.
  const Eigen::VectorXd& residual(const State& state);

  /// Residual, and tangents for several weights (System::linearize): matrices[first + i] for
  /// weights[i]. @param matrices  from System::make_matrix(), the same number in each call
  const Eigen::VectorXd& linearize(const State& state, WeightList weights, std::size_t first,
                                   std::vector<System::Matrix>& matrices);

  /// ∂R/∂x at fixed state, (n + m) × variables.
  Eigen::MatrixXd& design_derivative(const State& state);

  /// sums += those of μᵀ ∂R/∂x (System::add_parameter_adjoints); μ is (n + m) × any number.
  void add_parameter_adjoints(const State& state, const Eigen::MatrixXd& mu, Columns sums);

 private:
  /// A level on which constraints stand in the residual, and with which factor.
  struct Term {
    ConstraintLevel level;
    double factor;
  };

  System& system_;
  ConstraintLevel level_;
  std::vector<Term> others_;
  Eigen::VectorXd residual_, other_residual_;
  std::vector<System::Matrix> other_matrices_;
  Eigen::MatrixXd columns_, other_columns_, other_mu_;
};

}  // namespace pleuel
