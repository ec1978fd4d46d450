#pragma once

#include "core/beam/invariants.hpp"
#include "core/effects/body_equations.hpp"

namespace pleuel {

/// Eight numbers a column.
using Eights = Eigen::Array<double, 8, Eigen::Dynamic>;

/// Products of one motion that forces and tangents share; see PlanarConstants.
struct PlanarProducts {
  /// Rows of `of_coordinates`.
  enum Row { g_C, g_D, C_v, D_v, S_a, K_q, D_f_v, D_a };

  double omega, alpha;             ///< about n
  Eights of_coordinates;           ///< a column for each elastic coordinate
  Eigen::Vector3d c, shape_v;      ///< c and S̄ q̇_f
  Eigen::Vector3d force;           ///< f, body axes
  double inertia, g_C_v;           ///< I and g_Cᵀ q̇_f
  double moment;                   ///< n·T
  Eigen::VectorXd elastic_forces;  ///< F
  Eights rates;                    ///< scratch: what of_coordinates is made of
};

/// The invariants of a body whose frame turns by an angle about a fixed normal n (body axes, where
/// it is fixed, too). With P = I − n nᵀ and J = ñ the matrices of the general equations
/// (general_body_equations.hpp) are
///     X = −ω² P + α J,   Y = 2ω J
/// so that of all S_kl and H_kl two sums each are left, C = P_kl S_kl = Cᵀ, D = J_kl S_kl = −Dᵀ,
/// and with g_C = P_kl H_lk + C q_f, g_D = J_kl H_lk + D q_f
///     F = S_ff q̈_f + K q_f + D_f q̇_f + S̄ᵀ a₀ − ω² g_C + α g_D + 2ω D q̇_f
///     n·T = (n × c)·a₀ + α I + 2ω g_Cᵀ q̇_f + g_Dᵀ q̈_f,   I = P_kl J₀_kl + q_fᵀ (P_kl H_lk + g_C)
/// where −ω² P p, along p, has no moment about n. The forces are linear in these constants, too.
class PlanarConstants {
 public:
  PlanarConstants(const BodyFrame& frame, const Invariants<double>& invariants);

  /// All of the products.
  /// @param motion   of the frame
  /// @param elastic  of the coordinates that the invariants have
  void evaluate(const BodyMotion& motion, const ElasticMotion& elastic, PlanarProducts& out) const;

  const Eigen::Vector3d& normal() const { return normal_; }
  double mass() const { return mass_; }
  const Eigen::Matrix3Xd& shape() const { return shape_; }
  Eigen::Index size() const { return shape_.cols(); }
  /// K, D_f, S_ff, C, D: a column of non-zeros each.
  Eigen::MatrixXd matrices() const;

 private:
  void multiply(const ElasticMotion& elastic, PlanarProducts& out) const;

  Eigen::Vector3d normal_;
  double mass_;
  Eigen::Vector3d first_moment_;
  double inertia_at_rest_;  ///< P_kl J₀_kl
  Eigen::Matrix3Xd shape_;
  Eigen::Matrix2Xd mixed_;  ///< P_kl H_lk, J_kl H_lk
  ElasticPattern pattern_;
  Eights entries_;  ///< of each non-zero what PlanarProducts::of_coordinates is made with
};

/// The equations of a body whose frame turns by an angle, in the constants that are left of the
/// invariants then. Most of the time of planar simulations was spent in the
/// general equations, which are what tests compare these with.
class PlanarBodyEquations final : public BodyEquations {
 public:
  PlanarBodyEquations(const BodyFrame& frame, const Invariants<double>& invariants);

  void evaluate(const BodyMotion& motion) override;
  void add_forces(const BodyMotion& motion, Eigen::VectorXd& residual) const override;
  void write_tangent(const BodyMotion& motion, const Weights& weights, double* entries) override;

 private:
  using Basis = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3>;

  void write_frame_block(const BodyMotion& motion, const Weights& weights, double* entries) const;
  template <int Rows>
  void write_coupling(const BodyMotion& motion, const Weights& weights, double* entries) const;
  void write_elastic_block(const Weights& weights, double* entries) const;

  const BodyFrame& frame_;
  PlanarConstants body_;
  Eigen::MatrixXd matrices_;  ///< PlanarConstants::matrices()

  // Of the motion evaluated last.
  PlanarProducts products_;
  Basis basis_;  ///< directions in which the frame moves, body axes
};

/// Forces of dI/dx.
class PlanarDerivativeForces final : public DerivativeForces {
 public:
  PlanarDerivativeForces(const BodyFrame& frame, const Invariants<double>& derivative)
      : frame_(frame), derivative_(frame, derivative) {}

  void set_forces(const BodyMotion& motion, const ElasticMotion& elastic,
                  Eigen::VectorXd& forces) override;

 private:
  const BodyFrame& frame_;
  PlanarConstants derivative_;
  PlanarProducts products_;  ///< scratch
};

}  // namespace pleuel
