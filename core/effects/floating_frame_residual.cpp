#include "core/effects/floating_frame_residual.hpp"

#include <array>
#include <type_traits>

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

/// Where S_kl q_f goes in W: W_lk.
std::array<int, 9> transposed_pairs(const Invariants<double>& body) {
  std::array<int, 9> transposed{};
  for (std::size_t p = 0; p < body.pairs.size(); ++p) {
    transposed[p] = 3 * body.pairs[p].second + body.pairs[p].first;
  }
  return transposed;
}

/// One pass over the non-zeros. `Pairs` is the number of pairs (k, l) where the compiler may know
/// it.
/// @param visit  is shown each row with S_kl q_f, S_kl q̇_f and S_kl q̈_f, and its entry of
///               S_ff q̈_f + K q_f + D q̇_f
template <int Pairs, class Visit>
ElasticSums multiply_elastic(const Invariants<double>& body, const ElasticMotion& elastic,
                             const Visit& visit) {
  using Column = Eigen::Matrix<double, Pairs, 1, 0, Pairs == Eigen::Dynamic ? 9 : Pairs, 1>;
  const Eigen::Index pairs = body.pairs.size();
  ElasticSums sums;
  Column q_of_q = Column::Zero(pairs), v_of_q = q_of_q, a_of_q = q_of_q;
  for (int row = 0; row < body.size(); ++row) {
    Column of_q = Column::Zero(pairs), of_v = of_q, of_a = of_q;
    double force = 0.0;
    for (int i = body.pattern.row_start[row];
         i < body.pattern.row_start[static_cast<std::size_t>(row) + 1]; ++i) {
      const int col = body.pattern.column[i];
      const Eigen::Map<const Column> moment(body.moments.data() + i * pairs, pairs);
      const double q = elastic.q(col), v = elastic.v(col), a = elastic.a(col);
      of_q += q * moment;
      of_v += v * moment;
      of_a += a * moment;
      force += body.mass_matrix(i) * a + body.stiffness(i) * q + body.damping(i) * v;
    }
    visit(row, of_q, of_v, of_a, force);
    const Eigen::Map<const Vector3d> shape(body.shape.data() + 3 * row);
    const Eigen::Map<const Vector9> mixed(body.mixed.data() + 9 * row);
    const double q = elastic.q(row), v = elastic.v(row), a = elastic.a(row);
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
  const std::array<int, 9> transposed = transposed_pairs(body);
  for (Eigen::Index p = 0; p < q_of_q.size(); ++p) {
    const int place = transposed[p];
    sums.weighted_q(place) += q_of_q(p);
    sums.weighted_v(place) += v_of_q(p);
    sums.weighted_a(place) += a_of_q(p);
  }
  return sums;
}

/// Calls a function with the number of pairs as a constant, where it is a usual one.
template <class Function>
auto with_known_pairs(const Invariants<double>& body, const Function& function) {
  switch (body.pairs.size()) {
    case 4:
      return function(std::integral_constant<int, 4>());  // planar motion
    case 9:
      return function(std::integral_constant<int, 9>());  // spatial motion
    default:
      return function(std::integral_constant<int, Eigen::Dynamic>());
  }
}

/// Writes what couples frame and elasticity, and the forces of S_ff, K and D.
template <int Pairs>
ElasticSums multiply_elastic(const Invariants<double>& body, const ElasticMotion& elastic,
                             BodyProducts& out) {
  const CouplingRows rows(body);
  const Eigen::Index pairs = body.pairs.size();
  const std::array<int, 9> transposed = transposed_pairs(body);
  out.coupling.resize(rows.count, body.size());
  out.forces.resize(body.size());
  return multiply_elastic<Pairs>(
      body, elastic,
      [&](int row, const auto& of_q, const auto& of_v, const auto& of_a, double force) {
        out.forces(row) = force;
        auto column = out.coupling.col(row);
        column.template head<3>() = Eigen::Map<const Vector3d>(body.shape.data() + 3 * row);
        column.template segment<9>(CouplingRows::weighted) =
            Eigen::Map<const Vector9>(body.mixed.data() + 9 * row);
        for (Eigen::Index p = 0; p < pairs; ++p) {
          column(CouplingRows::weighted + transposed[p]) += of_q(p);
        }
        column.template segment<Pairs>(CouplingRows::rate, pairs) = of_v;
        column.template segment<Pairs>(rows.acceleration, pairs) = of_a;
      });
}

/// Writes the generalized forces F.
template <int Pairs>
ElasticSums multiply_elastic(const Invariants<double>& body, const ElasticMotion& elastic,
                             const BodyMotion& motion, double* forces) {
  using Column = Eigen::Matrix<double, Pairs, 1, 0, Pairs == Eigen::Dynamic ? 9 : Pairs, 1>;
  const Eigen::Index pairs = body.pairs.size();
  Column x(pairs), y(pairs);
  for (Eigen::Index p = 0; p < pairs; ++p) {
    const auto [r, c] = body.pairs[p];
    x(p) = motion.X(r, c);
    y(p) = motion.Y(r, c);
  }
  const Eigen::Map<const Vector9> weighted(motion.X.data());
  return multiply_elastic<Pairs>(
      body, elastic, [&](int row, const auto& of_q, const auto& of_v, const auto&, double force) {
        const Eigen::Map<const Vector3d> shape(body.shape.data() + 3 * row);
        const Eigen::Map<const Vector9> mixed(body.mixed.data() + 9 * row);
        forces[row] =
            force + motion.a0.dot(shape) + weighted.dot(mixed) + x.dot(of_q) + y.dot(of_v);
      });
}

/// Force and moment on the frame, body axes.
struct FrameForces {
  Vector3d c;
  Matrix3d M, B;
  Vector3d force, moment;
};

FrameForces frame_forces(const Invariants<double>& body, const ElasticSums& sums,
                         const BodyMotion& motion) {
  FrameForces out;
  out.c = body.first_moment + sums.shape_q;
  out.M = body.second_moment + square(sums.mixed_q).transpose() + square(sums.weighted_q);
  out.B = square(sums.weighted_v);
  out.force = body.mass * motion.a0 + motion.X * out.c + motion.Y * sums.shape_v + sums.shape_a;
  const Matrix3d N = out.c * motion.a0.transpose() + out.M * motion.X.transpose() +
                     out.B * motion.Y.transpose() + square(sums.weighted_a);
  out.moment = axial(N);
  return out;
}

/// residual.segment(row, …) += [ basisᵀ A f ; Gᵀ T ].
void add_frame_forces(const BodyFrame& frame, const FrameMotion<double>& motion,
                      const Vector3d& force, const Vector3d& moment, int row,
                      Eigen::Ref<Eigen::VectorXd> residual) {
  const int k = frame.translations(), rotations = frame.rotations();
  const Vector3d global = motion.A * force;
  for (int i = 0; i < k; ++i) residual(row + i) += frame.basis.col(i).dot(global);
  for (int i = 0; i < rotations; ++i) residual(row + k + i) += motion.G.col(i).dot(moment);
}

}  // namespace

void evaluate_body(const Invariants<double>& body, const BodyMotion& motion, BodyProducts& out) {
  const ElasticSums sums = with_known_pairs(body, [&](auto pairs) {
    return multiply_elastic<decltype(pairs)::value>(body, motion, out);
  });
  const FrameForces forces = frame_forces(body, sums, motion);
  out.shape_v = sums.shape_v;
  out.c = forces.c;
  out.M = forces.M;
  out.B = forces.B;
  out.force = forces.force;
  out.moment = forces.moment;
}

void set_derivative_forces(const Invariants<double>& derivative, const BodyFrame& frame,
                           const BodyMotion& motion, const ElasticMotion& elastic,
                           Eigen::VectorXd& forces) {
  forces.resize(frame.size() + derivative.size());
  const ElasticSums sums = with_known_pairs(derivative, [&](auto pairs) {
    return multiply_elastic<decltype(pairs)::value>(derivative, elastic, motion,
                                                    forces.data() + frame.size());
  });
  const FrameForces of_frame = frame_forces(derivative, sums, motion);
  forces.head(frame.size()).setZero();
  add_frame_forces(frame, motion.frame, of_frame.force, of_frame.moment, 0, forces);
}

void add_body_forces(const Invariants<double>& body, const BodyFrame& frame,
                     const BodyMotion& motion, const BodyProducts& products, int row,
                     Eigen::Ref<Eigen::VectorXd> residual) {
  add_frame_forces(frame, motion.frame, products.force, products.moment, row, residual);
  if (body.size() == 0) return;
  // F = S_ff q̈_f + K q_f + D q̇_f + S̄ᵀ a₀ + X_kl W_lk + Y_kl S_kl q̇_f
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 21, 1> factors(CouplingRows(body).acceleration);
  factors.head<3>() = motion.a0;
  Eigen::Map<Matrix3d>(factors.data() + CouplingRows::weighted) = motion.X;
  for (std::size_t p = 0; p < body.pairs.size(); ++p) {
    const auto [r, c] = body.pairs[p];
    factors(CouplingRows::rate + static_cast<Eigen::Index>(p)) = motion.Y(r, c);
  }
  auto forces = residual.segment(row + frame.size(), body.size());
  forces += products.forces;
  forces.noalias() += products.coupling.topRows(factors.size()).transpose() * factors;
}

}  // namespace pleuel
