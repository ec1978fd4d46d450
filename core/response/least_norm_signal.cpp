#include "core/response/least_norm_signal.hpp"

#include <utility>

#include "core/model/body_energy.hpp"

namespace pleuel {

LeastNormSignal::LeastNormSignal(std::unique_ptr<Signal> inner, std::shared_ptr<LeastNorm> norm,
                                 const Model& model)
    : inner_(std::move(inner)),
      norm_(std::move(norm)),
      joints_(terms_besides_bodies(model).acting, *model.mechanism.system),
      at_rest_(model.mechanism.system->coordinates(), model.mechanism.system->multipliers()),
      local_(model.mechanism.system->coordinates(), model.mechanism.system->multipliers(),
             model.mechanism.system->variables()),
      rows_(Eigen::VectorXd::Zero(model.mechanism.system->size())) {}

void LeastNormSignal::set(const State& state) {
  norm_->set(state);
  least_ = state;
  least_.lambda = norm_->apply(state.lambda);
}

void LeastNormSignal::observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) {
  set(state);
  inner_->observe(least_, values);
}

void LeastNormSignal::add_gradient(const State& state, int channel, double weight,
                                   SignalGradient& gradient) {
  set(state);
  local_.set_zero();
  inner_->add_gradient(least_, channel, weight, local_);
  const LeastNorm::Slope slope = norm_->slope(state.lambda, local_.lambda);
  gradient.v += local_.v;
  gradient.a += local_.a;
  gradient.lambda += slope.lambda;
  add_change_of_forces(slope.alpha, slope.left, local_);
  add_change_of_forces(slope.y, slope.beta, local_);
  gradient.q += local_.q;
  gradient.design += local_.design;
}

bool LeastNormSignal::is_determined(const State& state) {
  constexpr double round_off = 1e-6;
  set(state);
  for (int channel = 0; channel < channels(); ++channel) {
    local_.set_zero();
    inner_->add_gradient(least_, channel, 1.0, local_);
    const Eigen::VectorXd shared = norm_->slope(state.lambda, local_.lambda).beta;
    if (shared.norm() > round_off * local_.lambda.norm()) return false;
  }
  return true;
}

/// ∂(motionᵀ Φ_qᵀ λ)/∂(q, x): of what joints and loads exert, the part that is linear in λ.
void LeastNormSignal::add_change_of_forces(const Eigen::VectorXd& motion,
                                           const Eigen::VectorXd& multipliers,
                                           SignalGradient& gradient) {
  at_rest_.time = least_.time;
  at_rest_.q = least_.q;
  for (const double sign : {1.0, -1.0}) {
    at_rest_.lambda = sign > 0.0 ? multipliers : Eigen::VectorXd::Zero(multipliers.size());
    rows_.head(motion.size()) = sign * motion;
    joints_.add_gradient(at_rest_, ConstraintLevel::position, rows_, gradient);
  }
}

}  // namespace pleuel
