#include "core/effects/floating_frame_residual.hpp"

#include <array>

namespace pleuel {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using Vector9 = Eigen::Matrix<double, 9, 1>;

/// S̄, H and W times q_f, q̇_f, q̈_f.
struct ElasticSums {
  Vector3d shape_q = Vector3d::Zero(), shape_v = Vector3d::Zero(), shape_a = Vector3d::Zero();
  Vector9 mixed_q = Vector9::Zero(), mixed_v = Vector9::Zero(), mixed_a = Vector9::Zero();
  Vector9 weighted_q, weighted_v, weighted_a;
};

Matrix3d square(const Vector9& rows) {
  return Eigen::Map<const RowMajor3>(rows.data());
}

/// One pass over the non-zeros. `Pairs` is the number of pairs (k, l) where the compiler may know
/// it.
template <int Pairs>
ElasticSums multiply_elastic(const Invariants<double>& body, BodyProducts& out) {
  using Column = Eigen::Matrix<double, Pairs, 1, 0, Pairs == Eigen::Dynamic ? 9 : Pairs, 1>;
  const int n = body.size();
  const auto pairs = static_cast<Eigen::Index>(body.pairs.size());
  const CouplingRows rows(body);
  out.coupling.resize(rows.count, n);
  out.forces.resize(n);
  std::array<int, 9> transposed{};  // where S_kl q_f goes in W: W_lk
  for (std::size_t p = 0; p < body.pairs.size(); ++p) {
    transposed[p] = 3 * body.pairs[p].second + body.pairs[p].first;
  }
  ElasticSums sums;
  Column q_of_q = Column::Zero(pairs), v_of_q = q_of_q, a_of_q = q_of_q;
  for (int row = 0; row < n; ++row) {
    Column of_q = Column::Zero(pairs), of_v = of_q, of_a = of_q;
    double force = 0.0;
    for (int i = body.pattern.row_start[row];
         i < body.pattern.row_start[static_cast<std::size_t>(row) + 1]; ++i) {
      const int col = body.pattern.column[i];
      const Eigen::Map<const Column> moment(body.moments.data() + i * pairs, pairs);
      const double q = out.q(col), v = out.v(col), a = out.a(col);
      of_q += q * moment;
      of_v += v * moment;
      of_a += a * moment;
      force += body.mass_matrix(i) * a + body.stiffness(i) * q + body.damping(i) * v;
    }
    out.forces(row) = force;
    const Eigen::Map<const Vector3d> shape(body.shape.data() + 3 * row);
    const Eigen::Map<const Vector9> mixed(body.mixed.data() + 9 * row);
    auto column = out.coupling.col(row);
    column.head<3>() = shape;
    column.segment<9>(CouplingRows::weighted) = mixed;
    for (Eigen::Index p = 0; p < of_q.size(); ++p) {
      column(CouplingRows::weighted + transposed[p]) += of_q(p);
    }
    column.segment<Pairs>(CouplingRows::rate, pairs) = of_v;
    column.segment<Pairs>(rows.acceleration, pairs) = of_a;
    const double q = out.q(row), v = out.v(row), a = out.a(row);
    sums.shape_q += q * shape;
    sums.shape_v += v * shape;
    sums.shape_a += a * shape;
    sums.mixed_q += q * mixed;
    sums.mixed_v += v * mixed;
    sums.mixed_a += a * mixed;
    q_of_q += q * of_q;
    v_of_q += v * of_q;
    a_of_q += a * of_q;
  }
  sums.weighted_q = sums.mixed_q;
  sums.weighted_v = sums.mixed_v;
  sums.weighted_a = sums.mixed_a;
  for (Eigen::Index p = 0; p < q_of_q.size(); ++p) {
    const int place = transposed[p];
    sums.weighted_q(place) += q_of_q(p);
    sums.weighted_v(place) += v_of_q(p);
    sums.weighted_a(place) += a_of_q(p);
  }
  return sums;
}

ElasticSums multiply_elastic(const Invariants<double>& body, BodyProducts& out) {
  switch (body.pairs.size()) {
    case 4:
      return multiply_elastic<4>(body, out);  // planar motion
    case 9:
      return multiply_elastic<9>(body, out);  // spatial motion
    default:
      return multiply_elastic<Eigen::Dynamic>(body, out);
  }
}

}  // namespace

void evaluate_body(const Invariants<double>& body, const FrameMotion<double>& frame,
                   const Vector3d& gravity, BodyProducts& out) {
  const ElasticSums sums = multiply_elastic(body, out);
  const Matrix3d omega = skew<double>(frame.omega);
  out.X = skew<double>(frame.alpha) + omega * omega;
  out.Y = 2.0 * omega;
  out.a0 = frame.A.transpose() * (frame.r_ddot - gravity);
  out.c = body.first_moment + sums.shape_q;
  out.shape_v = sums.shape_v;
  out.M = body.second_moment + square(sums.mixed_q).transpose() + square(sums.weighted_q);
  out.B = square(sums.weighted_v);
  out.force = body.mass * out.a0 + out.X * out.c + out.Y * out.shape_v + sums.shape_a;
  const Matrix3d N = out.c * out.a0.transpose() + out.M * out.X.transpose() +
                     out.B * out.Y.transpose() + square(sums.weighted_a);
  out.moment = axial(N);
}

void add_body_forces(const Invariants<double>& body, const BodyFrame& frame,
                     const FrameMotion<double>& motion, const BodyProducts& products, int row,
                     Eigen::Ref<Eigen::VectorXd> residual) {
  const int k = frame.translations(), rotations = frame.rotations();
  const Vector3d global = motion.A * products.force;
  for (int i = 0; i < k; ++i) residual(row + i) += frame.basis.col(i).dot(global);
  for (int i = 0; i < rotations; ++i) {
    residual(row + k + i) += motion.G.col(i).dot(products.moment);
  }
  if (body.size() == 0) return;
  // F = S_ff q̈_f + K q_f + D q̇_f + S̄ᵀ a₀ + X_kl W_lk + Y_kl S_kl q̇_f
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 21, 1> factors(CouplingRows(body).acceleration);
  factors.head<3>() = products.a0;
  Eigen::Map<Matrix3d>(factors.data() + CouplingRows::weighted) = products.X;
  for (std::size_t p = 0; p < body.pairs.size(); ++p) {
    const auto [r, c] = body.pairs[p];
    factors(CouplingRows::rate + static_cast<Eigen::Index>(p)) = products.Y(r, c);
  }
  auto forces = residual.segment(row + frame.size(), body.size());
  forces += products.forces;
  forces.noalias() += products.coupling.topRows(factors.size()).transpose() * factors;
}

}  // namespace pleuel
