#include "core/effects/floating_frame_body.hpp"

#include "core/effects/invariant_sums.hpp"

namespace pleuel {

using Eigen::Matrix3d;
using Eigen::Vector3d;

FloatingFrameBody::FloatingFrameBody(
    std::string name, BodyFrame frame, Invariants<double> invariants,
    const std::vector<DesignDerivative<Invariants<double>>>& derivatives, const Vector3d& gravity)
    : name_(std::move(name)),
      frame_(std::move(frame)),
      invariants_(std::move(invariants)),
      layout_(invariants_),
      gravity_(gravity) {
  rigid_elastic_.resize(6, invariants_.size());
  elastic_rigid_.resize(invariants_.size(), 6);
  flat_derivatives_.resize(layout_.size(), static_cast<Eigen::Index>(derivatives.size()));
  derivatives_.reserve(derivatives.size());
  for (const auto& [variable, data] : derivatives) {
    flat_derivatives_.col(static_cast<Eigen::Index>(variables_.size())) =
        layout_.flatten(data).sparseView();
    variables_.push_back(variable);
    Derivative& derivative = derivatives_.emplace_back();
    derivative.variable = variable;
    derivative.invariants = without_zeros(data);
    derivative.forces.resize(frame_.size() + derivative.invariants.data.size());
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
    for (int i = pattern.row_start[static_cast<std::size_t>(row)];
         i < pattern.row_start[static_cast<std::size_t>(row) + 1]; ++i) {
      entries.emplace_back(elastic + row, elastic + pattern.column[static_cast<std::size_t>(i)]);
    }
  }
}

void FloatingFrameBody::evaluate(const State& state) {
  const int m = frame_.size(), n = invariants_.size();
  motion_ =
      frame_motion<double>(frame_, state.q.segment(frame_.offset, m),
                           state.v.segment(frame_.offset, m), state.a.segment(frame_.offset, m));
  products_.q = state.q.segment(frame_.offset + m, n);
  products_.v = state.v.segment(frame_.offset + m, n);
  products_.a = state.a.segment(frame_.offset + m, n);
}

void FloatingFrameBody::add_residual(const State& state, ConstraintLevel,
                                     Eigen::VectorXd& residual) {
  evaluate(state);
  evaluate_body(invariants_, motion_, gravity_, products_);
  add_body_forces(invariants_, frame_, motion_, products_, frame_.offset, residual);
}

/// Forces of dI/dx at the state evaluated last.
void FloatingFrameBody::evaluate(Derivative& derivative) {
  const PartialInvariants& partial = derivative.invariants;
  derivative.products.q = products_.q(partial.coordinates);
  derivative.products.v = products_.v(partial.coordinates);
  derivative.products.a = products_.a(partial.coordinates);
  evaluate_body(partial.data, motion_, gravity_, derivative.products);
  derivative.forces.setZero();
  add_body_forces(partial.data, frame_, motion_, derivative.products, 0, derivative.forces);
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

void FloatingFrameBody::add_design_sums(const State& state, ConstraintLevel, const ConstColumns& mu,
                                        Columns sums) {
  if (!is_designed()) return;
  evaluate(state);
  evaluate_body(invariants_, motion_, gravity_, products_);
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
    gradients.row(variables_[i]) += found.row(static_cast<Eigen::Index>(i));
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
  set_rigid_columns(weights);
  set_elastic_columns(weights);
  const int m = frame_.size(), n = invariants_.size();
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < m; ++j) *entries++ = rigid_rigid_(i, j);
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) *entries++ = rigid_elastic_(j, i);
    for (int j = 0; j < m; ++j) *entries++ = elastic_rigid_(i, j);
  }
  write_elastic_block(weights, entries);
}

/// Columns of the frame coordinates: the chain rule through a₀, ω and α.
void FloatingFrameBody::set_rigid_columns(const Weights& weights) {
  const int k = frame_.translations(), m = frame_.size();
  const BodyProducts<double>& p = products_;
  const Matrix3d omega = skew<double>(motion_.omega);
  for (int j = 0; j < m; ++j) {
    const bool turns = j >= k;
    const int rotation = j - k;
    Vector3d d_a0, d_omega = Vector3d::Zero(), d_alpha = Vector3d::Zero();
    Matrix3d d_A = Matrix3d::Zero();
    if (turns) {
      d_A = weights.q * motion_.A_p[static_cast<std::size_t>(rotation)];
      d_a0 = d_A.transpose() * (motion_.r_ddot - gravity_);
      d_omega = weights.v * motion_.G.col(rotation);
      d_alpha = weights.a * motion_.G.col(rotation);
    } else {
      d_a0 = weights.a * (motion_.A.transpose() * frame_.basis.col(j));
    }
    const Matrix3d d_w = skew<double>(d_omega);
    const Matrix3d d_X = skew<double>(d_alpha) + d_w * omega + omega * d_w;
    const Matrix3d d_Y = 2.0 * d_w;
    const Vector3d d_force = invariants_.mass * d_a0 + d_X * p.c + d_Y * p.shape_v;
    const Matrix3d d_N = p.c * d_a0.transpose() + p.M * d_X.transpose() + p.B * d_Y.transpose();
    const Vector3d d_global = motion_.A * d_force + d_A * p.force;
    const Vector3d d_moment = axial<double>(d_N);
    for (int i = 0; i < k; ++i) rigid_rigid_(i, j) = frame_.basis.col(i).dot(d_global);
    for (int i = 0; i < m - k; ++i) rigid_rigid_(k + i, j) = motion_.G.col(i).dot(d_moment);
    auto column = elastic_rigid_.col(j);
    column.noalias() = invariants_.shape.transpose() * d_a0;
    if (!turns) continue;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        if (d_X(r, c) != 0.0) column += d_X(r, c) * p.weighted.row(3 * c + r).transpose();
      }
    }
    for (std::size_t i = 0; i < invariants_.pairs.size(); ++i) {
      const auto [r, c] = invariants_.pairs[i];
      column += d_Y(r, c) * p.moment_v.row(static_cast<int>(i)).transpose();
    }
  }
}

/// Columns of the elastic coordinates in the rows of the frame.
void FloatingFrameBody::set_elastic_columns(const Weights& weights) {
  const int k = frame_.translations(), rotations = frame_.rotations();
  const BodyProducts<double>& p = products_;
  Matrix3d Q = weights.q * p.X + weights.v * p.Y;
  Q.diagonal().array() += weights.a;
  const Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> to_global =
      (motion_.A.transpose() * frame_.basis);
  for (int i = 0; i < invariants_.size(); ++i) {
    const Vector3d d_force = Q * invariants_.shape.col(i);
    for (int r = 0; r < k; ++r) rigid_elastic_(r, i) = to_global.col(r).dot(d_force);
    if (rotations == 0) continue;
    Matrix3d W;  // ∫ρ p_k S_l,i
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) W(r, c) = p.weighted(3 * r + c, i);
    }
    // L_kl = ∫ρ S_k,i a_l
    Matrix3d L = invariants_.shape.col(i) * p.a0.transpose() + W.transpose() * p.X.transpose();
    for (std::size_t pair = 0; pair < invariants_.pairs.size(); ++pair) {
      const auto [r, c] = invariants_.pairs[pair];
      const int row = static_cast<int>(pair);
      L.row(r) += p.moment_v(row, i) * p.Y.col(c).transpose();
      L(r, c) += p.moment_a(row, i);
    }
    const Vector3d d_moment = axial<double>(weights.q * L + W * Q.transpose());
    for (int r = 0; r < rotations; ++r) {
      rigid_elastic_(k + r, i) = motion_.G.col(r).dot(d_moment);
    }
  }
}

/// w_q (Σ X_kl S_kl + K) + w_v (Σ Y_kl S_kl + D) + w_a S_ff on the pattern of the body.
void FloatingFrameBody::write_elastic_block(const Weights& weights, double*& entries) const {
  const Matrix3d moments = weights.q * products_.X + weights.v * products_.Y;
  Eigen::Matrix<double, 9, 1> factor;
  for (std::size_t p = 0; p < invariants_.pairs.size(); ++p) {
    factor(static_cast<int>(p)) = moments(invariants_.pairs[p].first, invariants_.pairs[p].second);
  }
  const auto pairs = static_cast<Eigen::Index>(invariants_.pairs.size());
  for (int i = 0; i < invariants_.pattern.nonzeros(); ++i) {
    double entry = weights.q * invariants_.stiffness(i) + weights.v * invariants_.damping(i) +
                   weights.a * invariants_.mass_matrix(i);
    for (Eigen::Index p = 0; p < pairs; ++p) entry += factor(p) * invariants_.moments(i, p);
    *entries++ = entry;
  }
}

}  // namespace pleuel
