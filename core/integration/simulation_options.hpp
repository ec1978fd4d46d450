#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "core/base/time_integration.hpp"
#include "core/integration/scheme.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/system/term.hpp"

namespace pleuel {

struct Trajectory;  // core/integration/trajectory.hpp

/// The steps that are asked for, and what else a simulation has to know.
struct SimulationOptions : TimeIntegration {
  /// Where something that acts jumps or has a kink [s], in any order: steps end there.
  std::vector<double> breaks = {};
  /// What the states of the trajectory may take [byte]. Where they do not fit, some are kept as
  /// checkpoints, and the stretches between are simulated again when they are asked for.
  double memory = std::numeric_limits<double>::infinity();
  /// A motion of this mechanism, or of one close by, with other steps, which is known to be stable:
  /// equilibria, and what repeats itself, are looked for beside it. Null: from the start.
  const Trajectory* similar = nullptr;
};

/// Sees each instant as it is reached, beginning with step 0 (and again from there, if it turns out
/// on the way that the states do not fit into the memory).
using InstantObserver = std::function<void(int step, const State& state)>;

/// How many steps of a size a time takes, rounded up. A step that divides the time up to round-off is
/// not shortened.
double steps_within(double time, double step);

/// Number of equal steps of a simulation without breaks: the last time is end_time exactly.
int step_count(const TimeIntegration& options);

/// The instants of a simulation without control and splits. Between two breaks steps are equal, as
/// few as are no longer than asked for, so that their size changes little from one stretch to the
/// next: a change of the size leaves a transient in the multipliers of index 3. Breaks closer than
/// a quarter of a step to the one before, or to the start or the end, have no instant.
std::vector<double> regular_instants(const SimulationOptions& options);

/// Divides regular steps into parts of 2^-level of them, each beginning at a multiple of its size,
/// where the level follows the local error.
class LocalErrorControl {
 public:
  LocalErrorControl(const Mechanism& mechanism, const SimulationOptions& options);

  /// The smallest parts of a regular step.
  int parts() const { return 1 << finest_level_; }
  /// The end of the part that begins here, counted in smallest parts. The level rises until a part
  /// may begin here.
  int end_of_part(int begin);

  /// Local errors of a regular step in such parts, c h³ q⃛ each with q⃛ ≈ (a⁺ − a)/h, relative to
  /// what is allowed.
  double relative_error(const State& old, const State& found, const Scheme& scheme) const;
  /// The coordinate with the largest error.
  Eigen::Index worst_coordinate(const State& old, const State& found, const Scheme& scheme) const;

  /// Takes smaller parts. @returns false where there are none
  [[nodiscard]] bool refine();
  /// After a part with this relative error: larger parts, if it is that small.
  void accept(double relative_error);

  int level() const { return level_; }
  void set_level(int level) { level_ = level; }

 private:
  const Eigen::VectorXd& scale_;
  double allowed_;
  int finest_level_, level_ = 0;
};

}  // namespace pleuel
