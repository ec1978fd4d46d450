#pragma once

#include "core/integration/recorded_state.hpp"

namespace pleuel {

/// Recorded states, a column each.
struct StateColumns {
  Eigen::RowVectorXd time;
  Eigen::MatrixXd q, v, a;               ///< n rows
  Eigen::MatrixXd lambda;                ///< m rows, unscaled
  Eigen::MatrixXd eta;                   ///< m rows or none
  Eigen::MatrixXd drifted_q, drifted_v;  ///< n rows or none

  StateColumns() = default;
  /// @param like  a state of the same size
  StateColumns(const RecordedState& like, Eigen::Index columns);

  Eigen::Index capacity() const { return time.size(); }
  void resize(Eigen::Index columns);
  void set(Eigen::Index column, const RecordedState& state);
  void load(Eigen::Index column, State& state) const;
  void load_record(Eigen::Index column, RecordedState& state) const;
};

}  // namespace pleuel
