#include "core/effects/general_body_equations.hpp"

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

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// With all pairs (k, l), see CouplingRows.
constexpr std::size_t most_coupling_rows = 12 + 2 * 9;

/// out = left · right, column by column, without columns of `left` that are zero (most are in a
/// plane); `Rows` of it where the compiler may know them.
template <int Rows>
void multiply_columns(const Eigen::MatrixXd& left, const Eigen::MatrixXd& right, double* out) {
  constexpr int most = Rows == Eigen::Dynamic ? 12 : Rows;
  using Column = Eigen::Matrix<double, Rows, 1, 0, most, 1>;
  const Eigen::Index rows = left.rows();
  const auto column = [&](Eigen::Index k) {
    return Eigen::Map<const Column>(left.data() + k * rows, rows);
  };
  std::array<Eigen::Index, most_coupling_rows> used;
  std::size_t count = 0;
  for (Eigen::Index k = 0; k < left.cols(); ++k) {
    if (!column(k).isZero(0.0)) used[count++] = k;
  }
  for (Eigen::Index i = 0; i < right.cols(); ++i) {
    const double* factor = right.col(i).data();
    Column sum = Column::Zero(rows);
    for (std::size_t k = 0; k < count; ++k) sum += factor[used[k]] * column(used[k]);
    Eigen::Map<Column>(out + i * rows, rows) = sum;
  }
}

void multiply_columns(const Eigen::MatrixXd& left, const Eigen::MatrixXd& right, double* out) {
  switch (left.rows()) {
    case 6:
      return multiply_columns<6>(left, right, out);  // planar motion
    case 12:
      return multiply_columns<12>(left, right, out);  // spatial motion
    default:
      return multiply_columns<Eigen::Dynamic>(left, right, out);
  }
}

}  // namespace

GeneralBodyEquations::GeneralBodyEquations(const BodyFrame& frame,
                                           const Invariants<double>& invariants)
    : frame_(frame), invariants_(invariants) {
  frame_block_.resize(frame_.size(), frame_.size());
  coupling_.resize(2 * frame_.size(), CouplingRows(invariants_).count);
  elastic_.resize(invariants_.pattern.nonzeros(), 3 + invariants_.moments.cols());
  if (elastic_.rows() > 0) {
    elastic_ << invariants_.stiffness, invariants_.damping, invariants_.mass_matrix,
        invariants_.moments;
  }
}

void GeneralBodyEquations::evaluate(const BodyMotion& motion) {
  evaluate_body(invariants_, motion, products_);
}

void GeneralBodyEquations::add_forces(const BodyMotion& motion, Eigen::VectorXd& residual) const {
  add_body_forces(invariants_, frame_, motion, products_, frame_.offset, residual);
}

void GeneralBodyEquations::write_tangent(const BodyMotion& motion, const Weights& weights,
                                         double* entries) {
  const int m = frame_.size(), n = invariants_.size();
  set_frame_columns(motion, weights);
  set_elastic_columns(motion, weights);
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < m; ++j) *entries++ = frame_block_(i, j);
  }
  multiply_columns(coupling_, products_.coupling, entries);
  write_elastic_block(motion, weights, entries + 2 * m * n);
}

/// Columns of the frame coordinates: the chain rule through a₀, ω and α.
void GeneralBodyEquations::set_frame_columns(const BodyMotion& motion, const Weights& weights) {
  const int k = frame_.translations(), m = frame_.size();
  const BodyProducts& p = products_;
  const CouplingRows rows(invariants_);
  const Matrix3d omega = skew<double>(motion.frame.omega);
  coupling_.bottomRows(m).setZero();
  const auto set_column = [&](int j, const Vector3d& d_global, const Vector3d& d_moment,
                              const Vector3d& d_a0) {
    for (int i = 0; i < k; ++i) frame_block_(i, j) = frame_.basis.col(i).dot(d_global);
    for (int i = 0; i < m - k; ++i) frame_block_(k + i, j) = motion.frame.G.col(i).dot(d_moment);
    coupling_.row(m + j).head<3>() = d_a0;
  };
  for (int j = 0; j < k; ++j) {
    if (weights.a == 0.0) {
      frame_block_.col(j).setZero();
      continue;
    }
    const Vector3d d_a0 = weights.a * (motion.frame.A.transpose() * frame_.basis.col(j));
    set_column(j, invariants_.mass * (motion.frame.A * d_a0), p.c.cross(d_a0), d_a0);
  }
  for (int j = k; j < m; ++j) {
    const Vector3d turn = motion.frame.G.col(j - k);
    const Matrix3d d_A = weights.q * motion.frame.A_p[j - k];
    const Vector3d d_a0 = d_A.transpose() * (motion.frame.A * motion.a0);
    const Matrix3d d_w = weights.v * skew<double>(turn);
    const Matrix3d d_X = weights.a * skew<double>(turn) + d_w * omega + omega * d_w;
    const Matrix3d d_Y = 2.0 * d_w;
    const Vector3d d_force = invariants_.mass * d_a0 + d_X * p.c + d_Y * p.shape_v;
    const Matrix3d d_N = p.c * d_a0.transpose() + p.M * d_X.transpose() + p.B * d_Y.transpose();
    set_column(j, motion.frame.A * d_force + d_A * p.force, axial(d_N), d_a0);
    // W_lk meets X_kl.
    auto factors = coupling_.row(m + j);
    factors.segment<9>(CouplingRows::weighted) = d_X.reshaped().transpose();
    for (std::size_t pair = 0; pair < invariants_.pairs.size(); ++pair) {
      const auto [r, c] = invariants_.pairs[pair];
      factors(CouplingRows::rate + static_cast<Eigen::Index>(pair)) = d_Y(r, c);
    }
  }
}

/// Columns of the elastic coordinates in the rows of the frame. With Q = w_q X + w_v Y + w_a I the
/// change of f is Q S̄, and that of N is w_q (S̄ a₀ᵀ + Wᵀ Xᵀ + (S_kl q̇) Yᵀ + S_kl q̈) + W Qᵀ, of
/// which g · axial N = Z : N takes Z = −g̃.
void GeneralBodyEquations::set_elastic_columns(const BodyMotion& motion, const Weights& weights) {
  const int k = frame_.translations(), rotations = frame_.rotations();
  const CouplingRows rows(invariants_);
  Matrix3d Q = weights.q * motion.X + weights.v * motion.Y;
  Q.diagonal().array() += weights.a;
  coupling_.topRows(k).setZero();
  for (int i = 0; i < k; ++i) {
    coupling_.row(i).head<3>() = frame_.basis.col(i).transpose() * motion.frame.A * Q;
  }
  for (int i = 0; i < rotations; ++i) {
    const Matrix3d Z = -skew<double>(motion.frame.G.col(i));
    const Matrix3d ZY = weights.q * (Z * motion.Y);
    const Matrix3d of_W = weights.q * (Z * motion.X).transpose() + Z * Q;
    auto factors = coupling_.row(k + i);
    factors.head<3>() = weights.q * (Z * motion.a0);
    factors.segment<9>(CouplingRows::weighted) = of_W.reshaped<Eigen::RowMajor>().transpose();
    for (std::size_t pair = 0; pair < invariants_.pairs.size(); ++pair) {
      const auto [r, c] = invariants_.pairs[pair];
      factors(CouplingRows::rate + static_cast<Eigen::Index>(pair)) = ZY(r, c);
      factors(rows.acceleration + static_cast<Eigen::Index>(pair)) = weights.q * Z(r, c);
    }
  }
}

/// w_q (Σ X_kl S_kl + K) + w_v (Σ Y_kl S_kl + D) + w_a S_ff on the pattern of the body.
void GeneralBodyEquations::write_elastic_block(const BodyMotion& motion, const Weights& weights,
                                               double* entries) const {
  Eigen::Map<Eigen::VectorXd> block(entries, elastic_.rows());
  if (weights.q == 0.0 && weights.v == 0.0) {
    block = weights.a * elastic_.col(2);
    return;
  }
  const Matrix3d moments = weights.q * motion.X + weights.v * motion.Y;
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 12, 1> factors(elastic_.cols());
  factors.head<3>() << weights.q, weights.v, weights.a;
  for (std::size_t p = 0; p < invariants_.pairs.size(); ++p) {
    factors(3 + static_cast<Eigen::Index>(p)) =
        moments(invariants_.pairs[p].first, invariants_.pairs[p].second);
  }
  block.noalias() = elastic_ * factors;
}

}  // namespace pleuel
