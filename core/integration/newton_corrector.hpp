#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

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

// What a simulation says that cannot go on.

/// Where it is.
struct StepPlace {
  double time;  ///< [s]
  int step, steps;
};

/// " of the body \"rod\"": what the largest entry of a residual belongs to.
/// @param names  of equations (Mechanism::equation_names); empty text where there are none
std::string worst_equation(const Eigen::Ref<const Eigen::VectorXd>& residual,
                           const std::vector<std::string>& names);
/// The same for one equation.
std::string equation_text(Eigen::Index equation, const std::vector<std::string>& names);

/// @param step          that was tried last [s]
/// @param regular_step  [s]
[[noreturn]] void throw_failed(const StepPlace& place, const StepFailure& failure, double step,
                               double largest_residual, const std::string& equation,
                               double regular_step);
/// @param error  relative to what is allowed
[[noreturn]] void throw_inaccurate(const StepPlace& place, double step, double error,
                                   const std::string& equation);
[[noreturn]] void throw_not_finite(const StepPlace& place, const std::string& equation);
/// @param drift  [m or rad]
[[noreturn]] void throw_drifted(const StepPlace& place, double drift, const std::string& equation);

/// The pivots of a solver, shared by all checkpoints between which it did not choose others.
class PivotRecord {
 public:
  using Pivots = std::shared_ptr<const LinearSolver::Pivots>;

  Pivots of(const LinearSolver& solver) {
    if (solver.pivot_choices() != choice_) {
      pivots_ = std::make_shared<LinearSolver::Pivots>(solver.pivots());
      choice_ = solver.pivot_choices();
    }
    return pivots_;
  }

  void restore(const Pivots& pivots, LinearSolver& solver) {
    if (pivots == pivots_ && solver.pivot_choices() == choice_) return;
    solver.use_pivots(*pivots);
    pivots_ = pivots;
    choice_ = solver.pivot_choices();
  }

 private:
  Pivots pivots_;
  int choice_ = -1;  ///< of the solver, with these pivots
};

}  // namespace pleuel
