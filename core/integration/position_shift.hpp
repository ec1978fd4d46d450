#pragma once

#include <optional>
#include <vector>

#include "core/integration/state_columns.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/system/linear_forces.hpp"

namespace pleuel {

/// The equations that the stabilized index 2 adds to those of a step: a shift δ of positions along
/// the constraints of the old state q, whose tangent is constant in a step, such that the new
/// positions q⁺ close (Gear, Gupta & Leimkuhler 1985; W: weights of the assembly),
///     W δ + Φ_q(q)ᵀ η = 0,   Φ(q⁺) = 0                                               (n + m)
/// They are the second of two block rows of a step, with the unknowns (δ, η).
class PositionShift {
 public:
  explicit PositionShift(const Mechanism& mechanism);

  /// Zeros with the pattern of both block rows, 2 (n + m) square.
  const System::Matrix& pattern() const { return pattern_; }

  /// Goes on to the step that follows a state.
  void begin(const State& old);

  /// The equations at a state of the step, n + m entries.
  void residual(const State& state, const Eigen::VectorXd& shift, const Eigen::VectorXd& eta,
                Eigen::Ref<Eigen::VectorXd> residual);

  /// Tangents of the system at a state, on velocity level of the constraints.
  struct Tangents {
    const System::Matrix& step;    ///< for z, scaled
    const System::Matrix& with_q;  ///< for q, not scaled
    /// Φ_q in the rows of constraints, for changes of the increment; nothing else of it is read.
    const System::Matrix& constraints;
  };
  /// The matrix of both block rows.
  /// @param dynamic_scale, constraint_scale  factors of the rows of the first
  void write_matrix(const Tangents& tangents, double dynamic_scale, double constraint_scale,
                    System::Matrix& matrix) const;

  /// −(Φ_q(q)ᵀ η)_q s_q − (Φ_q(q)ᵀ η)_x and −Φ_x(q⁺), (n + m) × columns.
  /// @param old_q  s_q, n × columns
  /// @param of     where it is the old state, nothing has derivatives (.)_x
  void differentiate(const State& state, const Eigen::VectorXd& eta, const Eigen::MatrixXd& old_q,
                     DerivativesOf of, Eigen::Ref<Eigen::MatrixXd> rhs);
  /// The transposed: adds what y (n + m rows) makes of the derivatives of s_q and the parameter
  /// adjoints.
  void differentiate_transposed(const State& state, const Eigen::VectorXd& eta,
                                const ConstColumns& y, Columns old_q, Columns sums);

 private:
  /// Where an entry of the system's pattern stands in the four blocks.
  struct Slots {
    int in_11 = 0;
    std::optional<int> in_12, in_21, in_22;
  };

  void build_pattern();
  /// To the old state with η as multipliers.
  void set_forces(const Eigen::VectorXd& eta);

  const Mechanism& mechanism_;
  System& system_;
  System::Matrix pattern_;
  std::vector<Slots> slots_;  ///< one an entry of the system's pattern
  State old_;
  System::Matrix old_constraints_;  ///< Φ_q(q)ᵀ of the old state, in the columns of λ
  ConstraintTerms constraints_;
  State forces_;            ///< the old state at rest, with η: there R is Φ_q(q)ᵀ η
  System::Matrix tangent_;  ///< scratch
  Eigen::VectorXd values_;  ///< scratch
  Eigen::MatrixXd columns_, mu_;
};

}  // namespace pleuel
