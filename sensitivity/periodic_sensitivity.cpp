#include "sensitivity/periodic_sensitivity.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/integration/period_map.hpp"
#include "core/integration/repetition.hpp"
#include "core/integration/step_differentiation.hpp"

namespace pleuel {

namespace {

StateSensitivity zero_sensitivity(const System& system) {
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(system.coordinates(), system.variables());
  return {zero, zero, zero, zero, Eigen::MatrixXd::Zero(system.multipliers(), system.variables())};
}

/// Variables that change forces only, as the mass of a counterweight that a drive turns, have
/// derivatives of the motion that are round-off from end to end. Those of the size at which the
/// motion would change by this share of what the forces change count as such.
constexpr double next_to_nothing = 1e-6;

/// What is left of derivatives is compared with, one a variable.
/// @param end     of the states at the end of the period, stacked
/// @param lambda  of the multipliers there
Eigen::RowVectorXd compared_sizes(const Eigen::MatrixXd& end, const Eigen::MatrixXd& lambda,
                                  const Eigen::VectorXd& multipliers) {
  const Eigen::RowVectorXd sizes = sizes_of(end);
  const double forces = multipliers.lpNorm<Eigen::Infinity>();
  if (!(forces > 0.0)) return sizes;
  return sizes.cwiseMax(next_to_nothing / forces * sizes_of(lambda));
}

}  // namespace

void require_repeated_derivatives(Mechanism& mechanism, const Trajectory& trajectory) {
  const PeriodicStart& periodic = *trajectory.periodic;
  const std::string complaint =
      complaint_about_repeated_derivatives(mechanism, trajectory, periodic.steps, periodic.period);
  if (!complaint.empty()) throw SimulationError(complaint);
}

StateSensitivity periodic_sensitivity(Mechanism& mechanism, const Trajectory& trajectory) {
  const PeriodicStart& periodic = *trajectory.periodic;
  require_repeated_derivatives(mechanism, trajectory);
  const StackedStates& states = periodic.map->states();
  StateSensitivity start = zero_sensitivity(*mechanism.system);
  StepDifferentiation motion(mechanism, trajectory, DerivativesOf::design);
  PeriodicCorrection progress;
  State last;
  trajectory.states->load(periodic.steps, last);
  while (true) {
    motion.begin(start);
    while (motion.step() < periodic.steps) motion.advance();
    const Eigen::MatrixXd end = states.stack(motion.sensitivity()), gap = end - states.stack(start);
    start.lambda = motion.sensitivity().lambda;
    if (progress.is_done(gap, compared_sizes(end, start.lambda, last.lambda))) return start;
    const StateSensitivity step = states.unstack(progress.map(mechanism, trajectory).solve(gap));
    start.q += step.q;
    start.v += step.v;
    start.a += step.a;
    start.w += step.w;
  }
}

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
