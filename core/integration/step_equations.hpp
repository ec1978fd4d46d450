#pragma once

#include <optional>
#include <vector>

#include "core/base/time_integration.hpp"
#include "core/integration/position_shift.hpp"
#include "core/integration/scheme.hpp"
#include "core/integration/state_columns.hpp"
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

/// The state at the end of a step while it is looked for.
struct StepState : RecordedState {
  Eigen::VectorXd w;          ///< algorithmic acceleration of the scheme (n)
  Eigen::VectorXd increment;  ///< q = (q of the old state) ⊕ increment (n)
  /// δ, the part of the increment that closes the constraints; of the stabilized index 2 only (n).
  Eigen::VectorXd shift;
};

/// The equations of one step of a scheme in a formulation, for Newton's method, direct
/// differentiation and the adjoint. Unknowns are the correction z of the scheme and λ,
///     q⁺ = q ⊕ (history + z),  v⁺ = history + γ' z,  a⁺ = history + β' z
/// Equations, with s = 1/β' and c = 1, 1/γ', 1/β' for constraints on position, velocity and
/// acceleration level, so that the matrix is well conditioned as h → 0 (Bottasso, Dopico &
/// Trainelli 2008):
///     [ s R_dyn ; c Φ^(k) ] = 0                                                        (n + m)
/// The stabilized index 2 adds a shift of positions, q⁺ = q ⊕ (history + z + δ), and equations for
/// it (position_shift.hpp).
class StepEquations {
 public:
  StepEquations(const Mechanism& mechanism, const Scheme& scheme, const Formulation& formulation);

  /// Changes the step size.
  void set_scheme(const Scheme& scheme);

  /// n + m, or twice that.
  int size() const { return shift_ ? 2 * system_.size() : system_.size(); }
  System::Matrix make_matrix() const { return shift_ ? shift_->pattern() : system_.make_matrix(); }

  /// A state of this formulation at a state of the mechanism.
  StepState make_state(const State& start) const;

  /// Goes on to the step that follows a state.
  void begin(const State& old);

  /// All equations at a state of the step, size() entries.
  void residual(const StepState& state, Eigen::VectorXd& residual);
  /// And their tangent for the unknowns (z, s λ, δ, η), into a matrix from make_matrix().
  void linearize(const StepState& state, Eigen::VectorXd& residual, System::Matrix& matrix);

  /// Adds a correction of the unknowns to a state of the step.
  void apply(const Eigen::VectorXd& correction, StepState& state) const;

  // Sensitivities of the unknowns at a converged state solve  matrix · s = rhs.

  /// The matrix, and the tangents from which the other two make their products.
  void linearize_sensitivities(const StepState& state, System::Matrix& matrix);
  /// rhs, size() × columns: one a design variable, or any number.
  /// @param v, a   predicted parts of the sensitivities of v and a, n × columns
  /// @param old_q  sensitivity of the old state's q
  void differentiate(const StepState& state, const Eigen::MatrixXd& v, const Eigen::MatrixXd& a,
                     const Eigen::MatrixXd& old_q, Eigen::MatrixXd& rhs,
                     DerivativesOf of = DerivativesOf::design);
  /// The transposed of differentiate(): adds what the derivatives y of functions with respect to
  /// rhs (size() × functions) make of those with respect to v, a and old_q (n × functions), and the
  /// parameter adjoints (System::add_parameter_adjoints).
  void differentiate_transposed(const StepState& state, const ConstColumns& y, Columns v, Columns a,
                                Columns old_q, Columns sums);

 private:
  void combine_tangents();
  void write_residual(const StepState& state, const Eigen::VectorXd& of_system,
                      Eigen::VectorXd& residual);
  void write_matrix(const StepState& state, std::size_t q, System::Matrix& matrix);
  void set_constraint_rows(const StepState& state);

  const Mechanism& mechanism_;
  System& system_;
  Scheme scheme_;
  bool is_projected_;
  FormulatedSystem formulated_;
  std::optional<PositionShift> shift_;  ///< of the stabilized index 2
  double dynamic_scale_ = 0.0, constraint_scale_ = 0.0;
  State old_;
  Eigen::ArrayXd scales_;  ///< of the entries in coordinate columns
  std::vector<System::Matrix> matrices_;
  System::Matrix constraint_rows_;  ///< scratch: Φ_q for changes of the increment
  /// Entries of Φ_q in the rows of constraints, each with its transposed in the columns of λ.
  std::vector<std::pair<int, int>> transposed_;
  Eigen::MatrixXd columns_, mu_;  ///< scratch
};

}  // namespace pleuel
