#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/integration/period_map.hpp"
#include "core/integration/simulate.hpp"
#include "core/integration/state_columns.hpp"
#include "core/integration/trajectory.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/scene/problem_file.hpp"
#include "core/start/initial_state.hpp"

namespace pleuel {

/// @param columns  how many variables (or, of the adjoint, functions)
StateSensitivity zero_sensitivity(const System& system, Eigen::Index columns);

/// Derivatives of the consistent initial values: assembly, velocity projection and initial
/// accelerations are differentiated as they are computed (implicit function theorem), the curvature
/// of the constraints included.
StateSensitivity initial_sensitivity(Mechanism& mechanism, const InitialState& initial);

/// Derivatives of the values from which the first step sets out
/// (core/integration/damped_start.hpp).
StateSensitivity first_step_sensitivity(Mechanism& mechanism, const Trajectory& trajectory,
                                        const State& start, StateSensitivity initial);

/// A sentence for each variable with equal bounds whose derivatives are not those of the mechanism:
/// it would move a place along an elastic beam (core/scene/scene_rules.hpp).
std::vector<std::string> unknown_derivatives(const ProblemFile& problem, const Design<double>& x);

/// Derivatives of the start of a motion that repeats itself, by the implicit function theorem: with
/// Y(y₀, x) the end of the period that begins with y₀, and M = ∂Y/∂y₀,
///     Y(y₀(x), x) = y₀(x)   ⇒   dy₀/dx = (1 − M)⁻¹ ∂Y/∂x
/// The map that found the motion solves with 1 − M, but is one of a motion close by: what is left,
/// the difference between the end and the start of a differentiated period, is solved for again
/// until it is round-off.
/// @throws SimulationError if it does not become so, and as require_repeated_derivatives()
StateSensitivity periodic_sensitivity(Mechanism& mechanism, const Trajectory& trajectory);

/// The period is a number: at designs close by the motion has to repeat itself with the same one.
/// @throws SimulationError if it does not, as where a design variable is the speed of a drive
void require_repeated_derivatives(Mechanism& mechanism, const Trajectory& trajectory);

/// The largest magnitude in each column.
inline Eigen::RowVectorXd sizes_of(const Eigen::MatrixXd& columns) {
  return columns.cwiseAbs().colwise().maxCoeff();
}

/// When the repeated solution with 1 − M ends: where what is left is
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
