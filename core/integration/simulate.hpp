#pragma once

#include <functional>
#include <limits>
#include <memory>

#include "core/base/time_integration.hpp"
#include "core/integration/mechanism.hpp"
#include "core/integration/scheme.hpp"

namespace pleuel {

/// The steps that are asked for, and what else a simulation has to know.
struct SimulationOptions : TimeIntegration {
  /// Where something that acts jumps or has a kink [s], in any order: steps end there.
  std::vector<double> breaks = {};
  /// What the states of the trajectory may take [byte]. Where they do not fit, some are kept as
  /// checkpoints, and the stretches between are simulated again when they are asked for.
  double memory = std::numeric_limits<double>::infinity();
};

/// Sees each instant as it is reached, beginning with step 0 (and again from there, if it turns out
/// on the way that the states do not fit into the memory).
using InstantObserver = std::function<void(int step, const State& state)>;

/// States of a trajectory that are simulated again when they are asked for, bit by bit the same:
/// one stretch between two checkpoints at a time, so that going through all of them, forwards or
/// backwards, costs one simulation.
class RepeatedStates {
 public:
  virtual ~RepeatedStates() = default;
  virtual void load(int step, State& state) = 0;
  virtual void load_eta(int step, Eigen::VectorXd& eta) = 0;
  virtual void load_drifted(int step, State& state) = 0;

  virtual int checkpoints() const = 0;
  /// The most states that were held at once, besides the checkpoints.
  virtual int most_held() const = 0;
  /// Steps that were made again so far.
  virtual int repeated_steps() const = 0;
};

/// All steps of a simulation; column i belongs to time(i). Steps are equal, but for breaks, for
/// those that had to be split and those that were made smaller by the control of the local error.
struct Trajectory {
  Eigen::VectorXd time;
  // Where the states did not fit into the memory, these matrices are empty and `repeated` has them.
  Eigen::MatrixXd q, v, a;  ///< n × (steps + 1)
  Eigen::MatrixXd lambda;   ///< m × (steps + 1), unscaled
  Eigen::MatrixXd eta;      ///< m × (steps + 1), of the stabilized index 2 only
  /// What each step ended with before its projection (projection.hpp), n × (steps + 1); empty
  /// without.
  Eigen::MatrixXd drifted_q, drifted_v;
  Scheme scheme;  ///< of the regular steps
  SchemeType scheme_type = SchemeType::generalized_alpha;
  double spectral_radius = 0.8;
  Formulation formulation = {};
  int split_steps = 0;     ///< that Newton's method could not do: halved, which adds an instant
  int rejected_steps = 0;  ///< whose local error was too large: made again by halves
  double worst_condition = 0.0;  ///< of a step matrix, scaled: see LinearSolver
  int newton_iterations = 0;
  int factorizations = 0;

  /// Refers to the mechanism, which has to stay where it is; copies of the trajectory share it.
  std::shared_ptr<RepeatedStates> repeated;

  int steps() const { return static_cast<int>(time.size()) - 1; }
  void load(int step, State& state) const;
  void load_eta(int step, Eigen::VectorXd& eta) const;
  bool is_projected() const { return formulation.is_projected; }
  /// The state that a step ended with before its projection; without, as load().
  void load_drifted(int step, State& state) const;
  /// Size of a step, from 1: time(step) − time(step − 1) without the round-off of the instants [s].
  double step_size(int step) const;
  /// The scheme that made a step, from 1.
  Scheme scheme_of(int step) const;
  /// What the first step adds to the initial velocities, as a multiple of the jerk that the
  /// constraints prescribe (jerk.hpp) [s²].
  double weight_of_start_jerk() const;
};

/// Number of equal steps of a simulation without breaks: the last time is end_time exactly.
int step_count(const TimeIntegration& options);

/// The instants of a simulation without control and splits. Between two breaks steps are equal, as
/// few as are no longer than asked for, so that their size changes little from one stretch to the
/// next: a change of the size leaves a transient in the multipliers of index 3. Breaks closer than
/// a quarter of a step to the one before, or to the start or the end, have no instant.
std::vector<double> regular_instants(const SimulationOptions& options);

/// Integrates M a − Q + Φ_qᵀ λ = 0 with the constraints in the form that is asked for
/// (step_equations.hpp; for index 3 Arnold & Brüls 2007). Each step is solved by Newton's method
/// with the exact tangent of the beginning of the step (renewed where it converges slowly). A step
/// in which it fails is halved, up to six times. Nothing is allocated in the time loop but by the
/// observer, and for instants that are more than the regular ones. With a projection each step of
/// index 1 ends with it (projection.hpp).
/// @throws InputError if the memory does not even hold enough checkpoints of equal steps
/// @throws SimulationError saying time, step, iteration, equation and what to try; or that the
/// local
///         error is too large with the smallest step
Trajectory simulate(Mechanism& mechanism, const SimulationOptions& options,
                    const InstantObserver& observer = {});

}  // namespace pleuel
