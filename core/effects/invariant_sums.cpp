#include "core/effects/invariant_sums.hpp"

namespace pleuel {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// of_y: the derivative of μᵀR with respect to y.
struct BodyAdjoint {
  Matrix3d N, M, B;
  Vector3d c, shape_v;

  // The adjoint of axial() is −skew().
  BodyAdjoint(const BodyMotion& p, const BodyMultipliers& mu)
      : N(-skew<double>(mu.moment)),
        M(N * p.X),
        B(N * p.Y),
        c(p.X.transpose() * mu.force + N * p.a0),
        shape_v(p.Y.transpose() * mu.force) {}
};

/// `Pairs` is the number of pairs (k, l) where the compiler may know it.
template <int Pairs>
void add_sums(const Invariants<double>& body, const InvariantLayout& layout, const BodyMotion& p,
              const BodyMultipliers& mu, double* sums) {
  using Row = Eigen::Matrix<double, Pairs, 1, 0, Pairs == Eigen::Dynamic ? 9 : Pairs, 1>;
  const BodyAdjoint of(p, mu);
  const Eigen::Index pairs = body.pairs.size();
  Row of_moment_q(pairs), of_moment_v(pairs);
  double* of_shape = layout.shape(sums).data();
  double* of_mixed = layout.mixed(sums).data();
  double* of_mass_matrix = layout.mass_matrix(sums).data();
  double* of_stiffness = layout.stiffness(sums).data();
  double* of_damping = layout.damping(sums).data();
  for (int i = 0; i < body.size(); ++i) {
    const double q = p.q(i), v = p.v(i), a = p.a(i), e = mu.elastic(i);
    Eigen::Map<Vector3d>(of_shape + 3 * i) += q * of.c + v * of.shape_v + a * mu.force + e * p.a0;
    // W_kl = H_kl + S_kl q, and the H_lk that stands beside it in M; in rows k, by columns.
    const Matrix3d of_W =
        q * of.M.transpose() + v * of.B.transpose() + a * of.N.transpose() + e * p.X;
    Eigen::Map<Matrix3d>(of_mixed + 9 * i) += of_W + q * of.M;
    for (Eigen::Index pair = 0; pair < pairs; ++pair) {
      const auto [k, l] = body.pairs[pair];
      of_moment_q(pair) = of_W(k, l);
      of_moment_v(pair) = e * p.Y(k, l);
    }
    for (int entry = body.pattern.row_start[i]; entry < body.pattern.row_start[i + 1]; ++entry) {
      const int j = body.pattern.column[entry];
      Eigen::Map<Row>(layout.moments(sums, entry), pairs) +=
          p.q(j) * of_moment_q + p.v(j) * of_moment_v;
      of_mass_matrix[entry] += e * p.a(j);
      of_stiffness[entry] += e * p.q(j);
      of_damping[entry] += e * p.v(j);
    }
  }
  layout.mass(sums) += mu.force.dot(p.a0);
  layout.first_moment(sums) += of.c;
  layout.second_moment(sums) += of.M;
}

}  // namespace

void add_invariant_sums(const Invariants<double>& body, const InvariantLayout& layout,
                        const BodyMotion& motion, const BodyMultipliers& mu, double* sums) {
  switch (body.pairs.size()) {
    case 4:
      return add_sums<4>(body, layout, motion, mu, sums);  // planar motion
    case 9:
      return add_sums<9>(body, layout, motion, mu, sums);  // spatial motion
    default:
      return add_sums<Eigen::Dynamic>(body, layout, motion, mu, sums);
  }
}

}  // namespace pleuel
