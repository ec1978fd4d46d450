#pragma once

#include <limits>
#include <optional>

#include "core/integration/step_equations.hpp"
#include "core/mechanism/linear_solver.hpp"

namespace pleuel {

/// What a step failed at.
struct StepFailure {
  const char* what;
  int iteration;  ///< of Newton's method; 0: after it
};

/// Newton's method for the equations of a step. It keeps the factors within the step while they
/// serve, and learns from the steps before how fast it converges.
class NewtonCorrector {
 public:
  NewtonCorrector(const Mechanism& mechanism, const StepEquations& equations,
                  const TimeIntegration& options);

  /// Whether one iteration may be enough, judged by the curvature of the steps before.
  enum class Trust { usual, none };

  /// Corrects a predicted state until what is left is below the tolerance.
  /// @returns why not
  std::optional<StepFailure> correct(StepEquations& equations, StepState& state, Trust trust);

  /// Of the equations, at the beginning of the last iteration.
  const Eigen::VectorXd& residual() const { return residual_; }
  int iterations() const { return iterations_; }
  /// Of the last step.
  int iterations_of_step() const { return iterations_of_step_; }
  int factorizations() const { return solver_.factorizations(); }
  /// The worst of the step matrices, scaled: see LinearSolver.
  double worst_condition() const { return worst_condition_; }

  /// What is learnt from the steps before, besides the pivots of the solver.
  struct Experience {
    /// c of  |δ₂| = c |δ₁|²: how the method converges quadratically here.
    double curvature = std::numeric_limits<double>::infinity();
    double worst_pivots = std::numeric_limits<double>::infinity();
  };
  const Experience& experience() const { return experience_; }
  void set_experience(const Experience& experience) { experience_ = experience; }
  LinearSolver& solver() { return solver_; }

 private:
  bool linearize(StepEquations& equations, const StepState& state);
  /// Largest change of a coordinate, relative to its scale.
  double size_of_correction(const StepState& state) const;
  /// The curvature may fall slowly only.
  void record_curvature(double seen);
  /// The costly estimate where the cheap one is worse than ever.
  void record_condition();

  const Eigen::VectorXd& scale_;
  double tolerance_;
  int max_iterations_;
  Eigen::Index equations_of_system_;  ///< n + m; what follows are those of the shift
  System::Matrix matrix_;
  LinearSolver solver_;
  Eigen::VectorXd correction_, residual_;
  Experience experience_;
  int iterations_ = 0, iterations_of_step_ = 0;
  double worst_condition_ = 0.0;
};

}  // namespace pleuel
