#include "core/integration/state_columns.hpp"

#include "core/base/machine_memory.hpp"

namespace pleuel {

StateColumns::StateColumns(const RecordedState& like, Eigen::Index columns)
    : coordinates_(like.q.size()),
      multipliers_(like.lambda.size()),
      shift_multipliers_(like.eta.size()),
      drifted_coordinates_(like.drifted_q.size()),
      values_(1 + 3 * coordinates_ + multipliers_ + shift_multipliers_ + 2 * drifted_coordinates_,
              columns) {
  prefer_huge_pages(values_.data(), values_.size());
}

void StateColumns::resize(Eigen::Index columns) {
  values_.conservativeResize(Eigen::NoChange, columns);
}

void StateColumns::set(Eigen::Index column, const RecordedState& state) {
  auto values = values_.col(column);
  values(0) = state.time;
  Eigen::Index row = 1;
  for (const auto* part : {&state.q, &state.v, &state.a, &state.lambda, &state.eta,
                           &state.drifted_q, &state.drifted_v}) {
    values.segment(row, part->size()) = *part;
    row += part->size();
  }
}

void StateColumns::load(Eigen::Index column, State& state) const {
  const auto values = values_.col(column);
  state.time = values(0);
  const Eigen::Index n = coordinates_;
  state.q = values.segment(1, n);
  state.v = values.segment(1 + n, n);
  state.a = values.segment(1 + 2 * n, n);
  state.lambda = values.segment(1 + 3 * n, multipliers_);
}

void StateColumns::load_record(Eigen::Index column, RecordedState& state) const {
  load(column, state);
  const auto values = values_.col(column);
  const Eigen::Index first = 1 + 3 * coordinates_ + multipliers_;
  state.eta = values.segment(first, shift_multipliers_);
  state.drifted_q = values.segment(first + shift_multipliers_, drifted_coordinates_);
  state.drifted_v = values.tail(drifted_coordinates_);
}

}  // namespace pleuel
