#pragma once

#include "core/system/system.hpp"

namespace pleuel {

/// What a trajectory keeps of an instant.
struct RecordedState : State {
  /// Multipliers of the shift of positions, of the stabilized index 2 only (m).
  Eigen::VectorXd eta;
  /// q and v before the projection, of index 1 with projection only (n).
  Eigen::VectorXd drifted_q, drifted_v;
};

}  // namespace pleuel
