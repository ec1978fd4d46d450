#pragma once

#include <memory>

#include <Eigen/Core>

#include "core/integration/period_map.hpp"

namespace pleuel {

/// The largest magnitude in each column.
inline Eigen::RowVectorXd sizes_of(const Eigen::MatrixXd& columns) {
  return columns.cwiseAbs().colwise().maxCoeff();
}

/// When the repeated solution with 1 − M (periodic_sensitivity.hpp) ends: where what is left is
/// round-off, relative to the size of the whole, in each column.
class PeriodicCorrection {
 public:
  /// @throws SimulationError if it no longer shrinks with a map of the motion itself, and is more
  ///         than round-off
  bool is_done(const Eigen::MatrixXd& left, const Eigen::RowVectorXd& sizes);

  /// The map that solves: that of the search, or one of the motion itself where that is too far
  /// from it.
  const PeriodMap& map(Mechanism& mechanism, const Trajectory& trajectory);

 private:
  double before_ = 0.0;
  int count_ = 0;
  bool needs_own_map_ = false;
  std::shared_ptr<const PeriodMap> own_map_;
};

}  // namespace pleuel
