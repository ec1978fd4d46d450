#pragma once

#include <optional>
#include <vector>

#include "core/base/int_size.hpp"
#include "core/integration/damped_start.hpp"
#include "core/integration/newton_corrector.hpp"
#include "core/integration/predictor.hpp"
#include "core/integration/projection.hpp"
#include "core/integration/scheme.hpp"
#include "core/integration/simulation_options.hpp"
#include "core/integration/state_window.hpp"
#include "core/integration/trajectory.hpp"

namespace pleuel {

/// A simulation that can be stopped after each regular step, and taken up again at a checkpoint.
class TimeLoop {
 public:
  /// @param start  what to set out from instead of consistent initial values, as if a step had led
  ///               there: the end of a period that repeats itself; null: none
  TimeLoop(Mechanism& mechanism, const SimulationOptions& options, InstantObserver observer,
           const SchemeState* start = nullptr);

  /// Regular steps, or instants to be repeated: what the loop can be stopped after.
  int units() const { return int_size(grid_) - 1; }

  /// Stores the initial state. To be called once, first.
  /// @param capacity  of the window of states
  void start(Eigen::Index capacity);

  /// Makes the steps of a unit, from 1.
  void advance(int unit);

  /// Ends the simulation: what has been made, without the states. Nothing is observed any more.
  Trajectory end();

  /// Instant reached last.
  Eigen::Index instant() const { return stored_ - 1; }
  StateWindow& window() { return window_; }
  /// Leaves the present state in it.
  void empty_window();

  /// All that the steps to come depend on.
  struct Checkpoint {
    Eigen::Index instant;
    int unit;
    StepState state;
    NewtonCorrector::Experience experience;
    Predictor::Experience prediction;
    int level;                                ///< of the control of the local error
    std::vector<PivotRecord::Pivots> pivots;  ///< one a solver
  };

  /// @param unit  the last one
  Checkpoint checkpoint(int unit);

  /// Goes back, or forwards, to a checkpoint.
  void restore(const Checkpoint& checkpoint);

 private:
  /// That of the steps, and those of the projection.
  std::vector<LinearSolver*> solvers();

  /// Steps to the end of a regular step, as small as their local error asks for.
  void advance_controlled(double end);
  /// One step, or where it fails two of half the size.
  void advance_to(double time, int splits);
  /// A step of the scheme from the present state; the one before is kept in old_.
  /// @returns what it failed at
  std::optional<StepFailure> make_step(double time, NewtonCorrector::Trust trust);
  /// The scheme for a step to an instant.
  void use_step(double time);
  /// So that the first step makes no more of the initial values than it can resolve, and
  /// multipliers have their order from it on.
  void correct_start();
  /// What the steps set out from.
  StepState make_start(const SchemeState* start) const;
  /// Takes the step that was made into the trajectory.
  void accept();
  void store();

  /// Index 1 does not see how far its joints have come apart.
  void check_drift();
  void require_finite() const;
  [[noreturn]] void fail(const StepFailure& failure) const;

  double regular_step() const { return options_.end_time / steps_; }
  StepPlace place() const { return {state_.time, step_, steps_}; }

  Mechanism& mechanism_;
  System& system_;
  SimulationOptions options_;
  InstantObserver observer_;
  int steps_;                 ///< regular ones
  std::vector<double> grid_;  ///< the instants between which units are made
  Scheme scheme_;
  StepEquations equations_;
  StepState state_, old_;
  Predictor predictor_;
  NewtonCorrector corrector_;
  std::optional<Projection> projection_;
  LocalErrorControl control_;
  State start_;                              ///< consistent initial values
  std::optional<DampedStart> damped_start_;  ///< for a first step of this size:
  double damped_start_step_ = 0.0;           ///< [s]
  bool is_continued_;                        ///< starts as if a step had led there
  int step_ = 0;                             ///< regular step at work
  Eigen::Index stored_ = 0;                  ///< instants of the trajectory
  Trajectory trajectory_;                    ///< all but the states
  StateWindow window_;                       ///< the states of some instants, or of all
  std::vector<PivotRecord> pivot_records_;   ///< one a solver
  Eigen::VectorXd drift_;                    ///< scratch
};

}  // namespace pleuel
