#pragma once

#include <Eigen/Core>

#include "core/beam/invariants.hpp"
#include "core/frame/body_frame.hpp"

/// Inertia, elastic and damping forces of a body in the floating frame of reference formulation.
///
/// With the local acceleration of a material point
///     a = a₀ + X p + Y ṗ + p̈,   a₀ = Aᵀ(r̈ − g),  X = α̃ + ω̃ω̃,  Y = 2ω̃,  p = p₀ + S q_f
/// the virtual work of −ρ a gives, all in invariants (Shabana, Dynamics of Multibody Systems, ch.
/// 5, written with second moments of the mass distribution):
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

  Vector q, v, a;           ///< elastic coordinates and rates (n)
  Matrix moment_q;          ///< S_kl q_f, row of the pair (pairs × n)
  Matrix moment_v;          ///< S_kl q̇_f
  Matrix moment_a;          ///< S_kl q̈_f
  Vector forces;            ///< S_ff q̈_f + K q_f + D q̇_f
  Matrix weighted;          ///< W_kl in row 3k + l (9 × n)
  Vector3<Scalar> a0;       ///< [m/s²]
  Vector3<Scalar> c;        ///< ∫ρ p
  Vector3<Scalar> shape_v;  ///< S̄ q̇_f
  Matrix3<Scalar> X, Y, M, B;
  Vector3<Scalar> force;   ///< f, body axes
  Vector3<Scalar> moment;  ///< T about the frame origin, body axes
};

/// axial(N)_1 = N_23 − N_32 …: with N = ∫ρ p aᵀ the moment ∫ρ p × a.
template <class Scalar>
Vector3<Scalar> axial(const Matrix3<Scalar>& n) {
  return {n(1, 2) - n(2, 1), n(2, 0) - n(0, 2), n(0, 1) - n(1, 0)};
}

/// S_kl and the elastic forces times the elastic coordinates and their rates. `Pairs` is the number
/// of pairs (k, l) where the compiler may know it.
template <int Pairs, class Scalar>
void multiply_elastic(const Invariants<double>& body, BodyProducts<Scalar>& out) {
  const int n = body.size();
  const auto pairs = static_cast<Eigen::Index>(body.pairs.size());
  using Column = Eigen::Matrix<Scalar, Pairs, 1, 0, Pairs == Eigen::Dynamic ? 9 : Pairs, 1>;
  using Moments = Eigen::Map<const Eigen::Matrix<double, Pairs, 1>>;
  out.moment_q.resize(pairs, n);
  out.moment_v.resize(pairs, n);
  out.moment_a.resize(pairs, n);
  out.forces.resize(n);
  const double* moments = body.moments.data();
  for (int row = 0; row < n; ++row) {
    Column sum_q = Column::Constant(pairs, Scalar(0)), sum_v = sum_q, sum_a = sum_q;
    Scalar force(0);
    for (int i = body.pattern.row_start[static_cast<std::size_t>(row)];
         i < body.pattern.row_start[static_cast<std::size_t>(row) + 1]; ++i) {
      const int col = body.pattern.column[static_cast<std::size_t>(i)];
      const Moments moment(moments + i * pairs, pairs);
      const Scalar &q = out.q(col), &v = out.v(col), &a = out.a(col);
      for (Eigen::Index p = 0; p < pairs; ++p) {
        sum_q(p) += moment(p) * q;
        sum_v(p) += moment(p) * v;
        sum_a(p) += moment(p) * a;
      }
      force += body.mass_matrix(i) * a + body.stiffness(i) * q + body.damping(i) * v;
    }
    out.moment_q.col(row) = sum_q;
    out.moment_v.col(row) = sum_v;
    out.moment_a.col(row) = sum_a;
    out.forces(row) = force;
  }
}

template <class Scalar>
void multiply_elastic(const Invariants<double>& body, BodyProducts<Scalar>& out) {
  switch (body.pairs.size()) {
    case 4:
      return multiply_elastic<4>(body, out);  // planar motion
    case 9:
      return multiply_elastic<9>(body, out);  // spatial motion
    default:
      return multiply_elastic<Eigen::Dynamic>(body, out);
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
    out.weighted.row(3 * l + k) += out.moment_q.row(static_cast<int>(p));
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
  const Matrix3<Scalar> N =
      out.c * out.a0.transpose() + out.M * out.X.transpose() + out.B * out.Y.transpose() + D;
  out.moment = axial<Scalar>(N);
}

/// residual.segment(row, …) += [ basisᵀ A f ; Gᵀ T ; F ] of one body.
template <class Scalar, class Residual>
void add_body_forces(const Invariants<double>& body, const BodyFrame& frame,
                     const FrameMotion<Scalar>& motion, const BodyProducts<Scalar>& products,
                     int row, Residual& residual) {
  const int k = frame.translations(), rotations = frame.rotations();
  const Vector3<Scalar> global = motion.A * products.force;
  for (int i = 0; i < k; ++i) {
    const Vector3<Scalar> direction = frame.basis.col(i).template cast<Scalar>();
    residual(row + i) += direction.dot(global);
  }
  for (int i = 0; i < rotations; ++i) {
    residual(row + k + i) += motion.G.col(i).dot(products.moment);
  }
  const int first = row + frame.size();
  for (int i = 0; i < body.size(); ++i) {
    Scalar force = products.forces(i);
    for (int c = 0; c < 3; ++c) force += body.shape(c, i) * products.a0(c);
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) force += products.X(r, c) * products.weighted(3 * c + r, i);
    }
    for (std::size_t p = 0; p < body.pairs.size(); ++p) {
      const auto [r, c] = body.pairs[p];
      force += products.Y(r, c) * products.moment_v(static_cast<int>(p), i);
    }
    residual(first + i) += force;
  }
}

}  // namespace pleuel
