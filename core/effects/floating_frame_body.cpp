#include "core/effects/floating_frame_body.hpp"

#include <array>
#include <limits>

#include "core/effects/invariant_sums.hpp"

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

FloatingFrameBody::FloatingFrameBody(
    std::string name, BodyFrame frame, Invariants<double> invariants,
    const std::vector<DesignDerivative<Invariants<double>>>& derivatives, const Vector3d& gravity)
    : name_(std::move(name)),
      frame_(std::move(frame)),
      invariants_(std::move(invariants)),
      layout_(invariants_),
      gravity_(gravity) {
  evaluated_.setConstant(frame_.size() + invariants_.size(), 3,
                         std::numeric_limits<double>::quiet_NaN());
  frame_block_.resize(frame_.size(), frame_.size());
  coupling_.resize(2 * frame_.size(), CouplingRows(invariants_).count);
  elastic_.resize(invariants_.pattern.nonzeros(), 3 + invariants_.moments.cols());
  if (elastic_.rows() > 0) {
    elastic_ << invariants_.stiffness, invariants_.damping, invariants_.mass_matrix,
        invariants_.moments;
  }
  flat_derivatives_.resize(layout_.size(), derivatives.size());
  derivatives_.reserve(derivatives.size());
  for (const auto& [variable, data] : derivatives) {
    flat_derivatives_.col(variables_.size()) = layout_.flatten(data).sparseView();
    variables_.push_back(variable);
    Derivative& derivative = derivatives_.emplace_back();
    derivative.variable = variable;
    derivative.invariants = without_zeros(data);
  }
}

void FloatingFrameBody::declare_entries(EntryList& entries) const {
  const int m = frame_.size(), n = invariants_.size(), rigid = frame_.offset, elastic = rigid + m;
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < m; ++j) entries.emplace_back(rigid + i, rigid + j);
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) entries.emplace_back(rigid + j, elastic + i);
    for (int j = 0; j < m; ++j) entries.emplace_back(elastic + i, rigid + j);
  }
  const ElasticPattern& pattern = invariants_.pattern;
  for (int row = 0; row < n; ++row) {
    for (int i = pattern.row_start[row]; i < pattern.row_start[static_cast<std::size_t>(row) + 1];
         ++i) {
      entries.emplace_back(elastic + row, elastic + pattern.column[i]);
    }
  }
}

/// Nothing is left to do at the state evaluated last.
void FloatingFrameBody::evaluate(const State& state) {
  const int m = frame_.size(), n = invariants_.size(), first = frame_.offset;
  const auto q = state.q.segment(first, m + n), v = state.v.segment(first, m + n),
             a = state.a.segment(first, m + n);
  if (evaluated_.col(0) == q && evaluated_.col(1) == v && evaluated_.col(2) == a) return;
  evaluated_ << q, v, a;
  motion_ = frame_motion<double>(frame_, q.head(m), v.head(m), a.head(m));
  products_.q = q.tail(n);
  products_.v = v.tail(n);
  products_.a = a.tail(n);
  evaluate_body(invariants_, motion_, gravity_, products_);
}

void FloatingFrameBody::add_residual(const State& state, ConstraintLevel,
                                     Eigen::VectorXd& residual) {
  evaluate(state);
  add_body_forces(invariants_, frame_, motion_, products_, frame_.offset, residual);
}

/// Forces of dI/dx at the state evaluated last.
void FloatingFrameBody::evaluate(Derivative& derivative) {
  const PartialInvariants& partial = derivative.invariants;
  derivative.elastic.q = products_.q(partial.coordinates);
  derivative.elastic.v = products_.v(partial.coordinates);
  derivative.elastic.a = products_.a(partial.coordinates);
  set_derivative_forces(partial.data, frame_, motion_, derivative.elastic, products_,
                        derivative.forces);
}

void FloatingFrameBody::add_design_derivative(const State& state, ConstraintLevel,
                                              Eigen::MatrixXd& columns) {
  evaluate(state);
  const int m = frame_.size();
  for (Derivative& derivative : derivatives_) {
    evaluate(derivative);
    auto column = columns.col(derivative.variable);
    column.segment(frame_.offset, m) += derivative.forces.head(m);
    for (std::size_t i = 0; i < derivative.invariants.coordinates.size(); ++i) {
      column(frame_.offset + m + derivative.invariants.coordinates[i]) +=
          derivative.forces(m + static_cast<Eigen::Index>(i));
    }
  }
}

void FloatingFrameBody::add_parameter_adjoints(const State& state, ConstraintLevel,
                                               const ConstColumns& mu, Columns sums) {
  if (!is_designed()) return;
  evaluate(state);
  const int k = frame_.translations(), rotations = frame_.rotations();
  for (Eigen::Index i = 0; i < mu.cols(); ++i) {
    const auto of_body = mu.col(i).segment(frame_.offset, frame_.size() + invariants_.size());
    const Vector3d force = motion_.A.transpose() * (frame_.basis * of_body.head(k));
    const Vector3d moment = motion_.G.leftCols(rotations) * of_body.segment(k, rotations);
    add_invariant_sums(invariants_, layout_, products_,
                       {force, moment, of_body.tail(invariants_.size())}, sums.col(i).data());
  }
}

void FloatingFrameBody::add_design_gradients(const ConstColumns& sums,
                                             Eigen::MatrixXd& gradients) const {
  if (!is_designed()) return;
  const Eigen::MatrixXd found = flat_derivatives_.transpose() * sums;
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    gradients.row(variables_[i]) += found.row(i);
  }
}

void FloatingFrameBody::linearize(const State& state, const WeightList& weights,
                                  ConstraintLevel level, Eigen::VectorXd& residual,
                                  const EntryBlocks& entries) {
  add_residual(state, level, residual);
  for (std::size_t i = 0; i < weights.size(); ++i) write_tangent_of(weights[i], entries.block(i));
}

/// From the products of the last evaluation.
void FloatingFrameBody::write_tangent_of(const Weights& weights, double* entries) {
  const int m = frame_.size(), n = invariants_.size();
  set_frame_columns(weights);
  set_elastic_columns(weights);
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < m; ++j) *entries++ = frame_block_(i, j);
  }
  multiply_columns(coupling_, products_.coupling, entries);
  write_elastic_block(weights, entries + 2 * m * n);
}

/// Columns of the frame coordinates: the chain rule through a₀, ω and α.
void FloatingFrameBody::set_frame_columns(const Weights& weights) {
  const int k = frame_.translations(), m = frame_.size();
  const BodyProducts& p = products_;
  const CouplingRows rows(invariants_);
  const Matrix3d omega = skew<double>(motion_.omega);
  coupling_.bottomRows(m).setZero();
  const auto set_column = [&](int j, const Vector3d& d_global, const Vector3d& d_moment,
                              const Vector3d& d_a0) {
    for (int i = 0; i < k; ++i) frame_block_(i, j) = frame_.basis.col(i).dot(d_global);
    for (int i = 0; i < m - k; ++i) frame_block_(k + i, j) = motion_.G.col(i).dot(d_moment);
    coupling_.row(m + j).head<3>() = d_a0;
  };
  for (int j = 0; j < k; ++j) {
    if (weights.a == 0.0) {
      frame_block_.col(j).setZero();
      continue;
    }
    const Vector3d d_a0 = weights.a * (motion_.A.transpose() * frame_.basis.col(j));
    set_column(j, invariants_.mass * (motion_.A * d_a0), p.c.cross(d_a0), d_a0);
  }
  for (int j = k; j < m; ++j) {
    const Vector3d turn = motion_.G.col(j - k);
    const Matrix3d d_A = weights.q * motion_.A_p[j - k];
    const Vector3d d_a0 = d_A.transpose() * (motion_.r_ddot - gravity_);
    const Matrix3d d_w = weights.v * skew<double>(turn);
    const Matrix3d d_X = weights.a * skew<double>(turn) + d_w * omega + omega * d_w;
    const Matrix3d d_Y = 2.0 * d_w;
    const Vector3d d_force = invariants_.mass * d_a0 + d_X * p.c + d_Y * p.shape_v;
    const Matrix3d d_N = p.c * d_a0.transpose() + p.M * d_X.transpose() + p.B * d_Y.transpose();
    set_column(j, motion_.A * d_force + d_A * p.force, axial(d_N), d_a0);
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
void FloatingFrameBody::set_elastic_columns(const Weights& weights) {
  const int k = frame_.translations(), rotations = frame_.rotations();
  const BodyProducts& p = products_;
  const CouplingRows rows(invariants_);
  Matrix3d Q = weights.q * p.X + weights.v * p.Y;
  Q.diagonal().array() += weights.a;
  coupling_.topRows(k).setZero();
  for (int i = 0; i < k; ++i) {
    coupling_.row(i).head<3>() = frame_.basis.col(i).transpose() * motion_.A * Q;
  }
  for (int i = 0; i < rotations; ++i) {
    const Matrix3d Z = -skew<double>(motion_.G.col(i));
    const Matrix3d ZY = weights.q * (Z * p.Y);
    const Matrix3d of_W = weights.q * (Z * p.X).transpose() + Z * Q;
    auto factors = coupling_.row(k + i);
    factors.head<3>() = weights.q * (Z * p.a0);
    factors.segment<9>(CouplingRows::weighted) = of_W.reshaped<Eigen::RowMajor>().transpose();
    for (std::size_t pair = 0; pair < invariants_.pairs.size(); ++pair) {
      const auto [r, c] = invariants_.pairs[pair];
      factors(CouplingRows::rate + static_cast<Eigen::Index>(pair)) = ZY(r, c);
      factors(rows.acceleration + static_cast<Eigen::Index>(pair)) = weights.q * Z(r, c);
    }
  }
}

/// w_q (Σ X_kl S_kl + K) + w_v (Σ Y_kl S_kl + D) + w_a S_ff on the pattern of the body.
void FloatingFrameBody::write_elastic_block(const Weights& weights, double* entries) const {
  Eigen::Map<Eigen::VectorXd> block(entries, elastic_.rows());
  if (weights.q == 0.0 && weights.v == 0.0) {
    block = weights.a * elastic_.col(2);
    return;
  }
  const Matrix3d moments = weights.q * products_.X + weights.v * products_.Y;
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 12, 1> factors(elastic_.cols());
  factors.head<3>() << weights.q, weights.v, weights.a;
  for (std::size_t p = 0; p < invariants_.pairs.size(); ++p) {
    factors(3 + static_cast<Eigen::Index>(p)) =
        moments(invariants_.pairs[p].first, invariants_.pairs[p].second);
  }
  block.noalias() = elastic_ * factors;
}

}  // namespace pleuel
