#include "core/effects/euler_parameter_norm.hpp"

namespace pleuel {

void EulerParameterNorm::declare_entries(EntryList& entries) const {
  for (int i = first_; i < first_ + 4; ++i) {
    entries.emplace_back(i, i);
    entries.emplace_back(i, multiplier_);
    entries.emplace_back(multiplier_, i);
  }
}

void EulerParameterNorm::add_residual(const State& state, ConstraintLevel level,
                                      Eigen::VectorXd& residual) {
  const Eigen::Vector4d q = state.q.segment<4>(first_);
  const Eigen::Vector4d v = state.v.segment<4>(first_);
  const Eigen::Vector4d a = state.a.segment<4>(first_);
  const double lambda = state.lambda(multiplier_ - state.q.size());
  residual.segment<4>(first_) += lambda * q;
  switch (level) {
    case ConstraintLevel::position:
      residual(multiplier_) += (q.squaredNorm() - 1.0) / 2.0;
      break;
    case ConstraintLevel::velocity:
      residual(multiplier_) += q.dot(v);
      break;
    case ConstraintLevel::acceleration:
      residual(multiplier_) += v.squaredNorm() + q.dot(a);
      break;
  }
}

void EulerParameterNorm::linearize(const State& state, const Weights& weights,
                                   ConstraintLevel level, Eigen::VectorXd& residual,
                                   double* entries) {
  add_residual(state, level, residual);
  const Eigen::Vector4d q = state.q.segment<4>(first_);
  const Eigen::Vector4d v = state.v.segment<4>(first_);
  const Eigen::Vector4d a = state.a.segment<4>(first_);
  const double lambda = state.lambda(multiplier_ - state.q.size());
  Eigen::Vector4d row = weights.q * q;
  if (level == ConstraintLevel::velocity) row = weights.q * v + weights.v * q;
  if (level == ConstraintLevel::acceleration) {
    row = weights.q * a + 2.0 * weights.v * v + weights.a * q;
  }
  for (int i = 0; i < 4; ++i) {
    *entries++ = weights.q * lambda;
    *entries++ = q(i);
    *entries++ = row(i);
  }
}

}  // namespace pleuel
