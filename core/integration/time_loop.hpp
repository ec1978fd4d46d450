#pragma once

#include <optional>
#include <vector>

#include "core/base/int_size.hpp"
#include "core/integration/corner_jump.hpp"
#include "core/integration/damped_start.hpp"
#include "core/integration/newton_corrector.hpp"
#include "core/integration/projection.hpp"
#include "core/integration/scheme.hpp"
#include "core/integration/simulation_options.hpp"
#include "core/integration/state_columns.hpp"
#include "core/integration/step_equations.hpp"
#include "core/integration/trajectory.hpp"

namespace pleuel {

/// The state that Newton's method begins a step with: y⁺ = history · y (for q as q ⊕ increment),
/// then the correction that leads to the acceleration expected. a and λ are expected on a straight
/// line through the last two states. Coordinates in which the equations are linear may ring or
/// jump: they are right after one iteration wherever it begins.
class Predictor {
 public:
  explicit Predictor(const StepEquations& equations) : correction_(equations.size()) {}

  /// @param time       the end of the step [s]
  /// @param equations  those of the step
  void predict(const StepState& old, double time, const Scheme& scheme,
               const StepEquations& equations, StepState& state);

  /// Takes note of a step that was accepted.
  void record(const StepState& old, const StepState& state);
  bool looks_ahead() const { return experience_.step > 0.0; }
  /// Expects the accelerations that are, until a step is recorded.
  void forget() { experience_.step = 0.0; }

  /// How the last step went.
  struct Experience {
    double step = 0.0;                 ///< its size [s]; 0: there is none
    Eigen::VectorXd change_of_a;       ///< from its start to its end (n)
    Eigen::VectorXd change_of_lambda;  ///< (m)
  };
  const Experience& experience() const { return experience_; }
  void set_experience(const Experience& experience) { experience_ = experience; }

 private:
  Experience experience_;
  Eigen::VectorXd correction_;  ///< scratch
};

/// The states of consecutive instants.
class StateWindow {
 public:
  /// Of no capacity.
  StateWindow() = default;
  /// @param like  a state of the same size
  StateWindow(const RecordedState& like, Eigen::Index capacity) : columns_(like, capacity) {}

  /// Makes it empty, with this instant to come.
  void clear(Eigen::Index next) {
    first_ = next;
    count_ = 0;
  }

  /// Where there are more states than expected, it grows.
  void push(const RecordedState& state) {
    if (count_ == columns_.capacity()) columns_.resize(count_ + count_ / 8 + 64);
    columns_.set(count_++, state);
  }

  bool holds(Eigen::Index instant) const { return instant >= first_ && instant < first_ + count_; }
  void load(Eigen::Index instant, State& state) const { columns_.load(instant - first_, state); }
  void load_record(Eigen::Index instant, RecordedState& state) const {
    columns_.load_record(instant - first_, state);
  }

  /// All states; leaves none.
  StateColumns take() {
    if (count_ < columns_.capacity()) columns_.resize(count_);
    count_ = 0;
    return std::move(columns_);
  }

 private:
  Eigen::Index first_ = 0, count_ = 0;
  StateColumns columns_;
};

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
  /// Whether the step sets out from a corner of the motion: then from behind_corner_.
  bool passes_corner();
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
  std::optional<CornerJump> corner_;         ///< from the first break on
  StepState behind_corner_;                  ///< old_ as the step behind a corner takes it
  const StepState* from_ = nullptr;          ///< the one of both that the last step set out from
  std::vector<double> breaks_;               ///< ascending [s]
  bool is_continued_;                        ///< starts as if a step had led there
  int step_ = 0;                             ///< regular step at work
  Eigen::Index stored_ = 0;                  ///< instants of the trajectory
  Trajectory trajectory_;                    ///< all but the states
  StateWindow window_;                       ///< the states of some instants, or of all
  std::vector<PivotRecord> pivot_records_;   ///< one a solver
  Eigen::VectorXd drift_;                    ///< scratch
};

}  // namespace pleuel
