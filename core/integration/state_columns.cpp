#include "core/integration/state_columns.hpp"

namespace pleuel {

StateColumns::StateColumns(const RecordedState& like, Eigen::Index columns)
    : time(columns),
      q(like.q.size(), columns),
      v(like.v.size(), columns),
      a(like.a.size(), columns),
      lambda(like.lambda.size(), columns),
      eta(like.eta.size(), columns),
      drifted_q(like.drifted_q.size(), columns),
      drifted_v(like.drifted_v.size(), columns) {}

void StateColumns::resize(Eigen::Index columns) {
  time.conservativeResize(columns);
  for (auto* matrix : {&q, &v, &a, &lambda, &eta, &drifted_q, &drifted_v}) {
    matrix->conservativeResize(Eigen::NoChange, columns);
  }
}

void StateColumns::set(Eigen::Index column, const RecordedState& state) {
  time(column) = state.time;
  q.col(column) = state.q;
  v.col(column) = state.v;
  a.col(column) = state.a;
  lambda.col(column) = state.lambda;
  eta.col(column) = state.eta;
  drifted_q.col(column) = state.drifted_q;
  drifted_v.col(column) = state.drifted_v;
}

void StateColumns::load(Eigen::Index column, State& state) const {
  state.time = time(column);
  state.q = q.col(column);
  state.v = v.col(column);
  state.a = a.col(column);
  state.lambda = lambda.col(column);
}

void StateColumns::load_record(Eigen::Index column, RecordedState& state) const {
  load(column, state);
  state.eta = eta.col(column);
  state.drifted_q = drifted_q.col(column);
  state.drifted_v = drifted_v.col(column);
}

}  // namespace pleuel
