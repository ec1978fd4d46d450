#pragma once

#include <vector>

#include "core/base/time_integration.hpp"
#include "core/integration/mechanism.hpp"
#include "core/integration/recorded_state.hpp"
#include "core/integration/scheme.hpp"
#include "core/system/linear_forces.hpp"

namespace pleuel {

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
/// The stabilized index 2 adds a shift δ of positions along the constraints of the old state, whose
/// tangent is constant in a step (Gear, Gupta & Leimkuhler 1985; W: weights of the assembly):
///     q⁺ = q ⊕ (history + z + δ),   [ W δ + Φ_q(q)ᵀ η ; Φ(q⁺) ] = 0                    (n + m)
class StepEquations {
 public:
  StepEquations(Mechanism& mechanism, const Scheme& scheme, const Formulation& formulation);

  /// Changes the step size.
  void set_scheme(const Scheme& scheme);

  /// n + m, or twice that.
  int size() const { return is_stabilized() ? 2 * system_.size() : system_.size(); }
  System::Matrix make_matrix() const { return pattern_; }

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
  /// rhs, size() × variables.
  /// @param v, a   predicted parts of the sensitivities of v and a, n × variables
  /// @param old_q  sensitivity of the old state's q
  void differentiate(const StepState& state, const Eigen::MatrixXd& v, const Eigen::MatrixXd& a,
                     const Eigen::MatrixXd& old_q, Eigen::MatrixXd& rhs);
  /// The transposed of differentiate(): adds what the derivatives y of functions with respect to
  /// rhs (size() × functions) make of those with respect to v, a and old_q (n × functions), and the
  /// parameter adjoints (System::add_parameter_adjoints).
  void differentiate_transposed(const StepState& state, const ConstColumns& y, Columns v, Columns a,
                                Columns old_q, Columns sums);

 private:
  /// A level on which constraints stand in the residual, and with which factor.
  struct Level {
    ConstraintLevel level;
    double factor;
  };

  bool is_stabilized() const {
    return formulation_.constraints == ConstraintForm::stabilized_index_2;
  }
  void build_pattern();
  void evaluate(const StepState& state, WeightList weights, std::size_t first);
  void combine_tangents();
  void write_residual(const StepState& state, Eigen::VectorXd& residual);
  void write_matrix(const StepState& state, std::size_t q, std::size_t v, System::Matrix& matrix);
  void differentiate_old_constraints(const StepState& state, const Eigen::MatrixXd& old_q,
                                     Eigen::MatrixXd& rhs);
  void differentiate_old_constraints_transposed(const StepState& state, const ConstColumns& y,
                                                Columns old_q, Columns sums);

  Mechanism& mechanism_;
  System& system_;
  Scheme scheme_;
  Formulation formulation_;
  Level level_;                      ///< factor one
  std::vector<Level> other_levels_;  ///< of Baumgarte's terms
  double dynamic_scale_ = 0.0, constraint_scale_ = 0.0;
  State old_;
  Eigen::ArrayXd scales_;  ///< of the entries in coordinate columns
  System::Matrix pattern_;
  System::Matrix old_constraints_;  ///< Φ_q(q)ᵀ of the old state, in the columns of λ
  /// Where entries of the system's pattern stand in the four blocks of the pattern (−1: nowhere).
  std::vector<int> slots_11_, slots_12_, slots_21_, slots_22_;
  std::vector<System::Matrix> matrices_, other_matrices_;
  System::Matrix turned_;      ///< scratch
  LinearForces shift_forces_;  ///< Φ_q(q)ᵀ η of the old state
  Eigen::VectorXd residual_, other_residual_;
  Eigen::MatrixXd columns_, other_columns_, mu_, other_mu_;
};

}  // namespace pleuel
