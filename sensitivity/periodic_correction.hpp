#pragma once

#include <Eigen/Core>

namespace pleuel {

/// The largest magnitude in each column.
inline Eigen::RowVectorXd sizes_of(const Eigen::MatrixXd& columns) {
  return columns.cwiseAbs().colwise().maxCoeff();
}

/// When the repeated solution with 1 − M (periodic_sensitivity.hpp) ends: where what is left is
/// round-off, relative to the size of the whole, in each column.
class PeriodicCorrection {
 public:
  /// @throws SimulationError if it no longer shrinks, and is more than round-off
  bool is_done(const Eigen::MatrixXd& left, const Eigen::RowVectorXd& sizes);

 private:
  double before_ = 0.0;
  int count_ = 0;
};

}  // namespace pleuel
