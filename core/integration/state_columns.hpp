#pragma once

#include <Eigen/Core>

#include "core/system/system.hpp"

namespace pleuel {

/// What a trajectory keeps of an instant.
struct RecordedState : State {
  /// Multipliers of the shift of positions, of the stabilized index 2 only (m).
  Eigen::VectorXd eta;
  /// q and v before the projection, of index 1 with projection only (n).
  Eigen::VectorXd drifted_q, drifted_v;
};

/// Recorded states, a column each, in one block of memory.
class StateColumns {
 public:
  StateColumns() = default;
  /// @param like  a state of the same size
  StateColumns(const RecordedState& like, Eigen::Index columns);

  Eigen::Index capacity() const { return values_.cols(); }
  void resize(Eigen::Index columns);
  void set(Eigen::Index column, const RecordedState& state);
  void load(Eigen::Index column, State& state) const;
  void load_record(Eigen::Index column, RecordedState& state) const;

  auto q() { return values_.middleRows(1, coordinates_); }
  auto v() { return values_.middleRows(1 + coordinates_, coordinates_); }
  auto a() { return values_.middleRows(1 + 2 * coordinates_, coordinates_); }
  /// Unscaled.
  auto lambda() { return values_.middleRows(1 + 3 * coordinates_, multipliers_); }

 private:
  Eigen::Index coordinates_ = 0, multipliers_ = 0;
  Eigen::Index shift_multipliers_ = 0;    ///< m or none
  Eigen::Index drifted_coordinates_ = 0;  ///< n or none
  /// Rows: time; q, v, a; λ; η; drifted q and v.
  Eigen::MatrixXd values_;
};

/// With respect to what: the design variables, or anything that acts through the state before only.
enum class DerivativesOf { design, old_state };

/// Derivatives of one instant (one column for each variable).
struct StateSensitivity {
  Eigen::MatrixXd q, v, a;  ///< n × variables
  Eigen::MatrixXd w;        ///< of the scheme's algorithmic acceleration, n × variables
  Eigen::MatrixXd lambda;   ///< m × variables
};

}  // namespace pleuel
