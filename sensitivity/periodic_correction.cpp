#include "sensitivity/periodic_correction.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/integration/periodic_start.hpp"

namespace pleuel {

namespace {

constexpr double left_at_the_end = 1e-13;
/// What no longer shrinks is round-off below this.
constexpr double left_of_round_off = 1e-8;
constexpr int most_corrections = 30;

double largest_share(const Eigen::MatrixXd& left, const Eigen::RowVectorXd& sizes) {
  double largest = 0.0;
  for (Eigen::Index j = 0; j < left.cols(); ++j) {
    const double size = left.col(j).lpNorm<Eigen::Infinity>();
    if (size > 0.0) largest = std::max(largest, size / sizes(j));
  }
  return largest;
}

}  // namespace

bool PeriodicCorrection::is_done(const Eigen::MatrixXd& left, const Eigen::RowVectorXd& sizes) {
  const double share = largest_share(left, sizes);
  if (share <= left_at_the_end) return true;
  const bool shrinks = count_++ == 0 || share < 0.5 * before_;
  before_ = share;
  if (shrinks && count_ < most_corrections) return false;
  if (share <= left_of_round_off) return true;
  if (!needs_own_map_) {
    needs_own_map_ = true;
    count_ = 0;
    return false;
  }
  throw SimulationError(
      fmt::format("the derivatives of the motion that repeats itself do not converge: {:.1e} of "
                  "them is left after {} periods. Try a smaller /simulation/newton_tolerance, or "
                  "/sensitivity/method \"central-difference\"",
                  share, count_));
}

const PeriodMap& PeriodicCorrection::map(Mechanism& mechanism, const Trajectory& trajectory) {
  const PeriodicStart& periodic = *trajectory.periodic;
  if (!needs_own_map_) return *periodic.map;
  if (!own_map_) own_map_ = std::make_shared<PeriodMap>(mechanism, trajectory, periodic.steps);
  return *own_map_;
}

}  // namespace pleuel
