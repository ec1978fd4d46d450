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

void EulerParameterNorm::linearize(const State& state, const WeightList& weights,
                                   ConstraintLevel level, Eigen::VectorXd& residual,
                                   const EntryBlocks& entries) {
  add_residual(state, level, residual);
  const Eigen::Vector4d q = state.q.segment<4>(first_);
  const Eigen::Vector4d v = state.v.segment<4>(first_);
  const Eigen::Vector4d a = state.a.segment<4>(first_);
  const double lambda = state.lambda(multiplier_ - state.q.size());
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const Weights& w = weights[k];
    Eigen::Vector4d row = w.q * q;
    if (level == ConstraintLevel::velocity) row = w.q * v + w.v * q;
    if (level == ConstraintLevel::acceleration) row = w.q * a + 2.0 * w.v * v + w.a * q;
    double* entry = entries.block(k);
    for (int i = 0; i < 4; ++i) {
      *entry++ = w.q * lambda;
      *entry++ = q(i);
      *entry++ = row(i);
    }
  }
}

}  // namespace pleuel
