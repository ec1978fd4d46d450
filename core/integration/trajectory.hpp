#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "core/base/int_size.hpp"
#include "core/base/time_integration.hpp"
#include "core/integration/scheme.hpp"
#include "core/integration/state_columns.hpp"

namespace pleuel {

/// Where the states of a trajectory come from.
class StateSource {
 public:
  virtual ~StateSource() = default;
  /// May simulate: see RecomputedStates.
  virtual void load(int step, State& state) = 0;
  virtual void load_record(int step, RecordedState& state) = 0;
};

/// States that are held in memory.
class StoredStates final : public StateSource {
 public:
  explicit StoredStates(StateColumns columns) : columns_(std::move(columns)) {}

  void load(int step, State& state) override { columns_.load(step, state); }
  void load_record(int step, RecordedState& state) override { columns_.load_record(step, state); }
  StateColumns& columns() { return columns_; }

 private:
  StateColumns columns_;
};

/// States that are simulated again when they are asked for, bit by bit the same: one stretch
/// between two checkpoints at a time, so that going through all of them, forwards or backwards,
/// costs one simulation.
class RecomputedStates : public StateSource {
 public:
  virtual int checkpoints() const = 0;
  /// The most states that were held at once, besides the checkpoints.
  virtual int most_held() const = 0;
  /// Steps that were made again so far.
  virtual int recomputed_steps() const = 0;
};

struct PeriodicStart;  // core/integration/period_map.hpp

/// All steps of a simulation. Steps are equal, but for breaks, for those that had to be split and
/// those that were made smaller by the control of the local error.
struct Trajectory {
  Eigen::VectorXd time;  ///< steps + 1 instants [s]
  /// Of all instants. Recomputed states refer to the mechanism, which has to stay where it is;
  /// copies of the trajectory share them.
  std::shared_ptr<StateSource> states;
  bool has_constraints = false;
  Scheme scheme;  ///< of the regular steps
  SchemeType scheme_type = SchemeType::generalized_alpha;
  double spectral_radius = 0.8;
  Formulation formulation = {};
  /// Size of the step that would lead to the start, of a motion that repeats itself; 0: none [s].
  double step_before = 0.0;
  std::vector<int> corners;  ///< instants, ascending: see CornerJump
  Eigen::VectorXd end_w;     ///< algorithmic acceleration of the scheme at the last instant (n)
  /// How a motion that repeats itself was found; null: it starts as given.
  std::shared_ptr<const PeriodicStart> periodic;
  int split_steps = 0;     ///< that Newton's method could not do: halved, which adds an instant
  int rejected_steps = 0;  ///< whose local error was too large: made again by halves
  double worst_condition = 0.0;  ///< of a step matrix, scaled: see LinearSolver
  int newton_iterations = 0;
  int factorizations = 0;

  int steps() const { return int_size(time) - 1; }
  bool is_projected() const { return formulation.is_projected; }
  /// One of the states. Where steps must not allocate, `states` loads them into one that is there.
  State state_at(int step) const;
  /// The states, where memory holds all of them.
  /// @throws std::logic_error if it does not
  StateColumns& columns() const;
  /// The states as those that are simulated again; null where memory holds them.
  RecomputedStates* recomputed() const;
  /// Size of a step, from 1: time(step) − time(step − 1) without the round-off of the instants [s].
  double step_size(int step) const;
  /// The scheme that made a step, from 1.
  Scheme scheme_of(int step) const;
  /// What velocities of a step, from 1, are off by, as a multiple of the jerk that the constraints
  /// prescribe (damped_start.cpp, corner_jump.hpp) [s²].
  double weight_of_jerk(int step) const;
  /// Whether a step sets out from a corner of the motion.
  bool is_corner(int instant) const { return std::ranges::binary_search(corners, instant); }
};

}  // namespace pleuel
