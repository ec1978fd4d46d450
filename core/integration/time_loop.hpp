#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/integration/damped_start.hpp"
#include "core/integration/linear_solver.hpp"
#include "core/integration/projection.hpp"
#include "core/integration/simulate.hpp"
#include "core/integration/state_window.hpp"
#include "core/integration/step_equations.hpp"

namespace pleuel {

/// A simulation that can be stopped after each regular step, and taken up again at a checkpoint.
class TimeLoop {
 public:
  TimeLoop(Mechanism& mechanism, const SimulationOptions& options, InstantObserver observer);

  /// Regular steps, or instants to be repeated: what the loop can be stopped after.
  int units() const { return static_cast<int>(grid_.size()) - 1; }

  /// Stores the initial state. To be called once, first. @param room  for so many states
  void start(Eigen::Index room);

  /// Makes the steps of a unit, from 1.
  void advance(int unit);

  /// Ends the simulation: what has been made, without the states. Nothing is observed any more.
  Trajectory trajectory();

  /// Instant reached last.
  Eigen::Index instant() const { return stored_ - 1; }
  double time(Eigen::Index instant) const { return trajectory_.time(instant); }
  StateWindow& window() { return window_; }
  /// Leaves the present state in it.
  void empty_window();

  /// All that the steps to come depend on.
  struct Checkpoint {
    Eigen::Index instant;
    int unit;
    StepState state;
    double curvature, worst_pivots;
    int level;
    std::vector<std::shared_ptr<const LinearSolver::Pivots>> pivots;  ///< one a solver
  };

  /// @param unit  the last one
  Checkpoint checkpoint(int unit);

  /// Goes back, or forwards, to a checkpoint.
  void restore(const Checkpoint& checkpoint);

 private:
  /// The pivots of a solver, shared by all checkpoints between which it did not choose others.
  struct KeptPivots {
    std::shared_ptr<const LinearSolver::Pivots> pivots;
    int choice = -1;  ///< of the solver, with these pivots

    void take(const LinearSolver& solver);
    void give(const std::shared_ptr<const LinearSolver::Pivots>& from, LinearSolver& solver);
  };

  /// That of the steps, and those of the projection.
  std::vector<LinearSolver*> solvers();

  /// @throws SimulationError naming the first part of the state that is not finite
  void require_finite() const;
  void store();

  void advance_step(double end);

  /// A regular step in parts of 2^-level of it, each beginning at a multiple of its size, where the
  /// level follows the local error.
  void advance_controlled(double end);

  /// Error of a coordinate in a step, relative to its scale.
  double error_of(Eigen::Index i) const;
  Eigen::Index worst_coordinate() const;

  /// Local errors of a regular step in such parts, c h³ q⃛ each with q⃛ ≈ (a⁺ − a)/h, relative to
  /// what is allowed.
  double relative_error() const;

  /// One step, or where Newton's method fails two of half the size.
  void advance_to(double time, int splits);

  /// Index 1 does not see how far its joints have come apart.
  void check_drift();

  double regular_step() const { return options_.end_time / steps_; }

  /// The scheme for a step to an instant.
  void use_step(double time);

  /// So that the first step makes no more of the initial values than it can resolve, and
  /// multipliers have their order from it on.
  void set_out();

  /// y⁺ = history · y (for q as q ⊕ increment), then the correction that keeps the acceleration.
  void predict(double time);

  /// Largest change of a coordinate, relative to its scale.
  double size_of_correction() const;

  struct Failure {
    const char* what;
    int iteration;
  };

  /// Newton's method that keeps the factors within the step while they serve.
  /// @param is_careful  no trust in the curvature seen before
  std::optional<Failure> correct(bool is_careful);

  /// Newton's method, and the projection if there is one.
  std::optional<Failure> finish(bool is_careful);

  /// c of  |δ₂| = c |δ₁|²: how Newton's method converges quadratically here. It may fall slowly
  /// only.
  void note_curvature(double seen);

  bool linearize();

  /// The costly estimate where the cheap one is worse than ever.
  void note_condition();

  /// The equation that is met worst.
  std::string worst_equation() const;

  [[noreturn]] void fail(const std::optional<Failure>& failure, double error) const;

  [[noreturn]] void fail(const Failure& failure) const;

  System& system_;
  const Eigen::VectorXd& scale_;
  const std::vector<std::string>& equation_names_;
  SimulationOptions options_;
  InstantObserver observer_;
  Mechanism& mechanism_;
  int steps_;
  std::vector<double> grid_;  ///< the instants between which units are made
  Scheme scheme_;
  StepEquations equations_;
  StepState state_, old_;
  System::Matrix matrix_;
  LinearSolver solver_;
  Eigen::VectorXd correction_, residual_;
  std::optional<Projection> projection_;
  State start_;                         ///< consistent initial values
  std::optional<DampedStart> set_out_;  ///< for a first step of this size:
  double set_out_for_ = 0.0;            ///< [s]
  double curvature_ = std::numeric_limits<double>::infinity();
  double worst_pivots_ = std::numeric_limits<double>::infinity();
  int finest_level_, level_ = 0;  ///< of the parts of a regular step: 2^-level of it
  int step_ = 0;                  ///< regular step at work
  Eigen::Index stored_ = 0;       ///< instants of the trajectory
  Trajectory trajectory_;         ///< all but the states
  StateWindow window_;            ///< the states of some instants, or of all
  std::vector<KeptPivots> kept_;  ///< one a solver
};

}  // namespace pleuel
