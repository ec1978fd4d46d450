#pragma once

/// Inertia, elastic and damping forces of a body in the floating frame of reference formulation.
///
/// With the local acceleration of a material point
///     a = a₀ + X p + Y ṗ + p̈                                       (body_equations.hpp)
/// the virtual work of −ρ a gives, all in invariants (Shabana, Dynamics of Multibody Systems, ch.
/// 5, written with second moments of the mass distribution):
///     force    f = ∫ρ a               = m a₀ + X c + Y S̄ q̇_f + S̄ q̈_f,        c = c₀ + S̄ q_f
///     moment   T = axial ∫ρ p aᵀ,  N = ∫ρ p aᵀ = c a₀ᵀ + M Xᵀ + B Yᵀ + D       (3 × 3)
///     elastic  F = ∫ρ Sᵀ a + K q_f + D q̇_f
/// with W_kl = ∫ρ p_k S_l, M_kl = ∫ρ p_k p_l, B_kl = W_kl q̇_f, D_kl = W_kl q̈_f. Quadratic velocity
/// forces need no formula of their own.

#include <utility>

#include <Eigen/Core>

#include "core/beam/invariants.hpp"
#include "core/effects/body_equations.hpp"

namespace pleuel {

/// Products of one configuration that residual and tangent share.
struct BodyProducts {
  /// What the coupling of frame and elastic coordinates is made of, one column for each of these:
  /// S̄ (3), W (9, W_kl in row 3k + l), S_kl q̇_f and S_kl q̈_f (as many as pairs).
  Eigen::MatrixXd coupling;
  Eigen::VectorXd forces;   ///< S_ff q̈_f + K q_f + D q̇_f
  Eigen::Vector3d c;        ///< ∫ρ p
  Eigen::Vector3d shape_v;  ///< S̄ q̇_f
  Eigen::Matrix3d M, B;
  Eigen::Vector3d force;   ///< f, body axes
  Eigen::Vector3d moment;  ///< T about the frame origin, body axes
};

/// Rows of BodyProducts::coupling at which W, S_kl q̇_f and S_kl q̈_f begin.
struct CouplingRows {
  explicit CouplingRows(const Invariants<double>& body)
      : acceleration(rate + static_cast<Eigen::Index>(body.pairs.size())),
        count(acceleration + static_cast<Eigen::Index>(body.pairs.size())) {}
  static constexpr Eigen::Index weighted = 3, rate = 12;
  Eigen::Index acceleration, count;
};

/// axial(N)_1 = N_23 − N_32 …: with N = ∫ρ p aᵀ the moment ∫ρ p × a.
inline Eigen::Vector3d axial(const Eigen::Matrix3d& n) {
  return {n(1, 2) - n(2, 1), n(2, 0) - n(0, 2), n(0, 1) - n(1, 0)};
}

/// Everything but the generalized forces.
void evaluate_body(const Invariants<double>& body, const BodyMotion& motion, BodyProducts& out);

/// residual.segment(row, …) += [ basisᵀ A f ; Gᵀ T ; F ] of one body.
void add_body_forces(const Invariants<double>& body, const BodyFrame& frame,
                     const BodyMotion& motion, const BodyProducts& products, int row,
                     Eigen::Ref<Eigen::VectorXd> residual);

/// The same of invariants dI/dx in the motion of a body, without what only tangents need.
/// @param motion   of the body; its elastic coordinates are not read
/// @param elastic  of the coordinates that dI/dx has
/// @param forces   frame, then those coordinates; overwritten
void set_derivative_forces(const Invariants<double>& derivative, const BodyFrame& frame,
                           const BodyMotion& motion, const ElasticMotion& elastic,
                           Eigen::VectorXd& forces);

/// The equations for any motion of the frame, with a tangent derived by hand.
class GeneralBodyEquations final : public BodyEquations {
 public:
  GeneralBodyEquations(const BodyFrame& frame, const Invariants<double>& invariants);

  void evaluate(const BodyMotion& motion) override;
  void add_forces(const BodyMotion& motion, Eigen::VectorXd& residual) const override;
  void write_tangent(const BodyMotion& motion, const Weights& weights, double* entries) override;

 private:
  void set_frame_columns(const BodyMotion& motion, const Weights& weights);
  void set_elastic_columns(const BodyMotion& motion, const Weights& weights);
  void write_elastic_block(const BodyMotion& motion, const Weights& weights, double* entries) const;

  const BodyFrame& frame_;
  const Invariants<double>& invariants_;
  Eigen::MatrixXd elastic_;  ///< K, D, S_ff and S_kl, a column of non-zeros each

  // Scratch.
  BodyProducts products_;        ///< of the motion evaluated last
  Eigen::MatrixXd frame_block_;  ///< m × m
  /// The coupling of m frame coordinates with elastic coordinate i is this times column i of
  /// BodyProducts::coupling: entries (frame, i), then (i, frame); 2m × its rows.
  Eigen::MatrixXd coupling_;
};

/// Forces of dI/dx.
class GeneralDerivativeForces final : public DerivativeForces {
 public:
  GeneralDerivativeForces(const BodyFrame& frame, Invariants<double> derivative)
      : frame_(frame), derivative_(std::move(derivative)) {}

  void set_forces(const BodyMotion& motion, const ElasticMotion& elastic,
                  Eigen::VectorXd& forces) override {
    set_derivative_forces(derivative_, frame_, motion, elastic, forces);
  }

 private:
  const BodyFrame& frame_;
  Invariants<double> derivative_;
};

}  // namespace pleuel
