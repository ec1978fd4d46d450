#include "core/integration/state_window.hpp"

#include <utility>

namespace pleuel {

void StateWindow::resize(const StepState& like, Eigen::Index columns) {
  for (auto* matrix : {&q_, &v_, &a_}) matrix->resize(like.q.size(), columns);
  lambda_.resize(like.lambda.size(), columns);
  eta_.resize(like.eta.size(), columns);
  for (auto* matrix : {&drifted_q_, &drifted_v_}) matrix->resize(like.drifted_q.size(), columns);
}

void StateWindow::make_room(Eigen::Index columns) {
  for (auto* matrix : {&q_, &v_, &a_, &lambda_, &eta_, &drifted_q_, &drifted_v_}) {
    matrix->conservativeResize(Eigen::NoChange, columns);
  }
}

void StateWindow::clear(Eigen::Index next) {
  first_ = next;
  count_ = 0;
}

void StateWindow::push(const StepState& state) {
  q_.col(count_) = state.q;
  v_.col(count_) = state.v;
  a_.col(count_) = state.a;
  lambda_.col(count_) = state.lambda;
  eta_.col(count_) = state.eta;
  drifted_q_.col(count_) = state.drifted_q;
  drifted_v_.col(count_) = state.drifted_v;
  ++count_;
}

void StateWindow::load(Eigen::Index instant, State& state) const {
  const Eigen::Index column = instant - first_;
  state.q = q_.col(column);
  state.v = v_.col(column);
  state.a = a_.col(column);
  state.lambda = lambda_.col(column);
}

void StateWindow::load_eta(Eigen::Index instant, Eigen::VectorXd& eta) const {
  eta = eta_.col(instant - first_);
}

void StateWindow::load_drifted(Eigen::Index instant, State& state) const {
  state.q = drifted_q_.col(instant - first_);
  state.v = drifted_v_.col(instant - first_);
}

void StateWindow::move_to(Trajectory& trajectory) {
  if (!is_full()) make_room(count_);
  trajectory.q = std::move(q_);
  trajectory.v = std::move(v_);
  trajectory.a = std::move(a_);
  trajectory.lambda = std::move(lambda_);
  trajectory.eta = std::move(eta_);
  trajectory.drifted_q = std::move(drifted_q_);
  trajectory.drifted_v = std::move(drifted_v_);
}

}  // namespace pleuel
