#pragma once

#include <Eigen/Core>

#include "core/beam/invariants.hpp"
#include "core/frame/body_frame.hpp"

/// Inertia, elastic and damping forces of a body in the floating frame of reference formulation.
///
/// With the local acceleration of a material point
///     a = a₀ + X p + Y ṗ + p̈,   a₀ = Aᵀ(r̈ − g),  X = α̃ + ω̃ω̃,  Y = 2ω̃,  p = p₀ + S q_f
/// the virtual work of −ρ a gives, all in invariants (Shabana, Dynamics of Multibody Systems, ch. 5,
/// written with second moments of the mass distribution):
///     force    f = ∫ρ a               = m a₀ + X c + Y S̄ q̇_f + S̄ q̈_f,        c = c₀ + S̄ q_f
///     moment   T = axial ∫ρ p aᵀ,  N = ∫ρ p aᵀ = c a₀ᵀ + M Xᵀ + B Yᵀ + D       (3 × 3)
///     elastic  F = ∫ρ Sᵀ a + K q_f + D q̇_f
/// with W_kl = ∫ρ p_k S_l, M_kl = ∫ρ p_k p_l, B_kl = W_kl q̇_f, D_kl = W_kl q̈_f. Quadratic velocity
/// forces need no formula of their own.
namespace pleuel {

/// Products of one configuration that residual and tangent share.
template <class Scalar>
struct BodyProducts {
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

  Vector q, v, a;          ///< elastic coordinates and rates (n)
  Matrix moment_q;         ///< S_kl q_f, column of the pair (n × pairs)
  Matrix moment_v;         ///< S_kl q̇_f
  Matrix moment_a;         ///< S_kl q̈_f
  Vector forces;           ///< S_ff q̈_f + K q_f + D q̇_f
  Matrix weighted;         ///< W_kl in row 3k + l (9 × n)
  Vector3<Scalar> a0;      ///< [m/s²]
  Vector3<Scalar> c;       ///< ∫ρ p
  Vector3<Scalar> shape_v; ///< S̄ q̇_f
  Matrix3<Scalar> X, Y, M, B;
  Vector3<Scalar> force;   ///< f, body axes
  Vector3<Scalar> moment;  ///< T about the frame origin, body axes
};

/// axial(N)_1 = N_23 − N_32 …: with N = ∫ρ p aᵀ the moment ∫ρ p × a.
template <class Scalar>
Vector3<Scalar> axial(const Matrix3<Scalar>& n) {
  return {n(1, 2) - n(2, 1), n(2, 0) - n(0, 2), n(0, 1) - n(1, 0)};
}

/// S_kl and the elastic forces times the elastic coordinates and their rates.
template <class Scalar>
void multiply_elastic(const Invariants<double>& body, BodyProducts<Scalar>& out) {
  const int n = body.size();
  const auto pairs = static_cast<Eigen::Index>(body.pairs.size());
  out.moment_q.setConstant(n, pairs, Scalar(0));
  out.moment_v.setConstant(n, pairs, Scalar(0));
  out.moment_a.setConstant(n, pairs, Scalar(0));
  out.forces.setConstant(n, Scalar(0));
  for (int row = 0; row < n; ++row) {
    Scalar force(0);
    for (int i = body.pattern.row_start[static_cast<std::size_t>(row)];
         i < body.pattern.row_start[static_cast<std::size_t>(row) + 1]; ++i) {
      const int col = body.pattern.column[static_cast<std::size_t>(i)];
      const Scalar& q = out.q(col);
      const Scalar& v = out.v(col);
      const Scalar& a = out.a(col);
      for (Eigen::Index p = 0; p < pairs; ++p) {
        const double moment = body.moments(i, p);
        out.moment_q(row, p) += moment * q;
        out.moment_v(row, p) += moment * v;
        out.moment_a(row, p) += moment * a;
      }
      force += body.mass_matrix(i) * a + body.stiffness(i) * q + body.damping(i) * v;
    }
    out.forces(row) = force;
  }
}

/// Everything but the generalized forces. Expects out.q, out.v, out.a to be set.
template <class Scalar>
void evaluate_body(const Invariants<double>& body, const FrameMotion<Scalar>& frame,
                   const Eigen::Vector3d& gravity, BodyProducts<Scalar>& out) {
  multiply_elastic(body, out);
  out.weighted = body.mixed.template cast<Scalar>();
  for (std::size_t p = 0; p < body.pairs.size(); ++p) {
    const auto [k, l] = body.pairs[p];
    out.weighted.row(3 * l + k) += out.moment_q.col(static_cast<int>(p)).transpose();
  }
  const Matrix3<Scalar> omega = skew<Scalar>(frame.omega);
  out.X = skew<Scalar>(frame.alpha) + omega * omega;
  out.Y = 2.0 * omega;
  out.a0 = frame.A.transpose() * (frame.r_ddot - gravity.template cast<Scalar>());
  out.c = body.first_moment.template cast<Scalar>();
  out.M = body.second_moment.template cast<Scalar>();
  out.B.setConstant(Scalar(0));
  Matrix3<Scalar> D = Matrix3<Scalar>::Constant(Scalar(0));
  out.shape_v.setConstant(Scalar(0));
  Vector3<Scalar> shape_a = Vector3<Scalar>::Constant(Scalar(0));
  for (int i = 0; i < body.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const double shape = body.shape(k, i);
      out.c(k) += shape * out.q(i);
      out.shape_v(k) += shape * out.v(i);
      shape_a(k) += shape * out.a(i);
      for (int l = 0; l < 3; ++l) {
        const Scalar& w = out.weighted(3 * k + l, i);
        out.M(k, l) += body.mixed(3 * l + k, i) * out.q(i) + w * out.q(i);
        out.B(k, l) += w * out.v(i);
        D(k, l) += w * out.a(i);
      }
    }
  }
  out.force = body.mass * out.a0 + out.X * out.c + out.Y * out.shape_v + shape_a;
  const Matrix3<Scalar> N = out.c * out.a0.transpose() + out.M * out.X.transpose() +
                            out.B * out.Y.transpose() + D;
  out.moment = axial<Scalar>(N);
}

/// residual.segment(frame.offset, …) += [ basisᵀ A f ; Gᵀ T ; F ] of one body.
template <class Scalar, class Residual>
void add_body_forces(const Invariants<double>& body, const BodyFrame& frame,
                     const FrameMotion<Scalar>& motion, const BodyProducts<Scalar>& products,
                     Residual& residual) {
  const int k = frame.translations(), rotations = frame.rotations();
  const Vector3<Scalar> global = motion.A * products.force;
  for (int i = 0; i < k; ++i) {
    const Vector3<Scalar> direction = frame.basis.col(i).template cast<Scalar>();
    residual(frame.offset + i) += direction.dot(global);
  }
  for (int i = 0; i < rotations; ++i) {
    residual(frame.offset + k + i) += motion.G.col(i).dot(products.moment);
  }
  const int first = frame.offset + frame.size();
  for (int i = 0; i < body.size(); ++i) {
    Scalar force = products.forces(i);
    for (int c = 0; c < 3; ++c) force += body.shape(c, i) * products.a0(c);
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) force += products.X(r, c) * products.weighted(3 * c + r, i);
    }
    for (std::size_t p = 0; p < body.pairs.size(); ++p) {
      const auto [r, c] = body.pairs[p];
      force += products.Y(r, c) * products.moment_v(i, static_cast<int>(p));
    }
    residual(first + i) += force;
  }
}

}  // namespace pleuel
