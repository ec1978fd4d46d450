#include "core/effects/general_body_equations.hpp"

#include <array>

namespace pleuel {

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
