#include "core/integration/step_differentiation.hpp"

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/stop.hpp"
#include "core/mechanism/mechanism.hpp"

namespace pleuel {

StepDifferentiation::StepDifferentiation(const Mechanism& mechanism, const Trajectory& trajectory,
                                         DerivativesOf of)
    : system_(*mechanism.system),
      rotations_(mechanism.rotations),
      trajectory_(trajectory),
      of_(of),
      scheme_(trajectory.scheme),
      equations_(mechanism, scheme_, trajectory.formulation),
      state_(equations_.make_state(State(system_.coordinates(), system_.multipliers()))),
      matrix_(equations_.make_matrix()),
      solver_(matrix_, mechanism.elastic) {
  if (!trajectory.corners.empty()) corner_.emplace(mechanism);
  if (trajectory.is_projected()) projection_.emplace(mechanism);
}

void StepDifferentiation::begin(StateSensitivity start, int instant) {
  step_ = instant;
  trajectory_.states->load(instant, state_);
  sensitivity_ = std::move(start);
  old_ = sensitivity_;
}

bool StepDifferentiation::advance() {
  if (step_ == trajectory_.steps()) return false;
  check_stop();
  ++step_;
  scheme_ = trajectory_.scheme_of(step_);
  equations_.set_scheme(scheme_);
  pass_corner();
  equations_.begin(state_);
  old_q_ = state_.q;
  trajectory_.states->load_record(step_, state_);
  swap_projected();
  state_.increment = difference(rotations_, state_.q, old_q_);
  predict();
  solve();
  project();
  return true;
}

void StepDifferentiation::pass_corner() {
  if (!trajectory_.is_corner(step_ - 1) || !corner_->find(state_, scheme_.step)) return;
  const auto jumps = corner_->differentiate(sensitivity_, of_);
  sensitivity_.v += trajectory_.weight_of_jerk(step_) * jumps.jerk;
  sensitivity_.a += jumps.acceleration;
  sensitivity_.w += jumps.acceleration + scheme_.delay * jumps.jerk;
}

/// ŝ = history · s, then shifted along the correction to ŝ_q = 0: the unknown is s_q itself, in
/// the rows of rotations T(Δ)⁻¹ s_q.
void StepDifferentiation::predict() {
  std::swap(old_, sensitivity_);
  old_q_x_ = old_.q;
  pull_back(rotations_, state_.increment, old_.q);
  const Eigen::Matrix4d& h = scheme_.history;
  const auto combine = [&](int row, Eigen::MatrixXd& out) {
    out = h(row, 0) * old_.q + h(row, 1) * old_.v + h(row, 2) * old_.a + h(row, 3) * old_.w;
  };
  combine(0, sensitivity_.q);
  combine(1, sensitivity_.v);
  combine(2, sensitivity_.a);
  combine(3, sensitivity_.w);
  const Eigen::Vector4d& b = scheme_.correction;
  sensitivity_.v -= b(1) / b(0) * sensitivity_.q;
  sensitivity_.a -= b(2) / b(0) * sensitivity_.q;
  sensitivity_.w -= b(3) / b(0) * sensitivity_.q;
}

void StepDifferentiation::solve() {
  const int n = system_.coordinates(), m = system_.multipliers();
  const Eigen::Vector4d& b = scheme_.correction;
  equations_.linearize_sensitivities(state_, matrix_);
  equations_.differentiate(state_, sensitivity_.v, sensitivity_.a, old_q_x_, rhs_, of_);
  if (!solver_.factorize(matrix_)) {
    throw SimulationError(fmt::format("the sensitivities are singular at t = {:.6g} s (step {})",
                                      state_.time, step_));
  }
  solver_.solve(rhs_);
  if (!rhs_.allFinite()) {
    throw SimulationError(fmt::format("the sensitivities are not finite at t = {:.6g} s (step {})",
                                      state_.time, step_));
  }
  if (!solver_.is_accurate()) {
    throw SimulationError(fmt::format(
        "the equations of the sensitivities at t = {:.6g} s (step {}) are met to {:.1e} only",
        state_.time, step_, solver_.backward_error()));
  }
  sensitivity_.q = rhs_.topRows(n);
  sensitivity_.lambda = rhs_.middleRows(n, m) / scheme_.dynamic_scale();
  sensitivity_.v += b(1) / b(0) * sensitivity_.q;
  sensitivity_.a += b(2) / b(0) * sensitivity_.q;
  sensitivity_.w += b(3) / b(0) * sensitivity_.q;
  if (rhs_.rows() > n + m) sensitivity_.q += rhs_.middleRows(n + m, n);
  push_forward(rotations_, state_.increment, sensitivity_.q);
}

/// From the state after the projection to that before it, and back.
void StepDifferentiation::swap_projected() {
  if (!projection_) return;
  state_.q.swap(state_.drifted_q);
  state_.v.swap(state_.drifted_v);
}

void StepDifferentiation::project() {
  if (!projection_) return;
  projection_->linearize(state_);
  projection_->differentiate(sensitivity_.q, sensitivity_.v, of_);
  swap_projected();
}

}  // namespace pleuel
