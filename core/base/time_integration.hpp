#pragma once

#include <vector>

/// What is asked of a time integration, in words that problem files and integration share.
namespace pleuel {

enum class SchemeType {
  generalized_alpha,
  newmark,        ///< γ, β from the spectral radius; average acceleration for 1
  implicit_euler  ///< first order, damps everything
};

/// How the constraints Φ(q, t) = 0 stand in the equations of a step.
enum class ConstraintForm {
  index_3,             ///< Φ = 0
  stabilized_index_2,  ///< dΦ/dt = 0 and Φ = 0 (Gear, Gupta & Leimkuhler 1985)
  index_1              ///< d²Φ/dt² + 2 b dΦ/dt + b² Φ = 0 (b > 0: Baumgarte 1972)
};

struct Formulation {
  ConstraintForm constraints = ConstraintForm::index_3;
  double baumgarte = 0.0;  ///< b of index 1 [1/s]; 0 lets the constraints drift
  /// Whether each step of index 1 ends with a projection to Φ = 0 and dΦ/dt = 0.
  bool is_projected = false;
};

/// What a problem file and a simulation say alike of the steps.
struct TimeIntegration {
  double end_time = 0.0;         ///< [s]; the start is t = 0
  double step = 0.0;             ///< [s]; shortened so that it divides the time
  double spectral_radius = 0.8;  ///< ρ∞ of the scheme, in [0, 1]
  /// Newton's method ends when the error left in any coordinate, relative to its scale, is
  /// estimated to be below this. Gradients by differences need a tight one.
  double newton_tolerance = 1e-10;
  int max_newton_iterations = 20;
  SchemeType scheme = SchemeType::generalized_alpha;
  Formulation formulation = {};
  /// What the local errors of the coordinates within one step may add up to, each relative to its
  /// scale: steps are halved, again and again, until that holds. 0: all steps are equal.
  /// Generalized-α only, and not index 3.
  double local_error = 0.0;
  double smallest_step = 0.0;  ///< of those halves [s]; 0: a 1024th of the step
  /// After which the motion repeats itself from the start on [s]; 0: it starts as given. The time is
  /// a whole number of periods.
  double period = 0.0;
  /// To repeat a sequence of steps: the instants of another simulation, in place of control [s].
  std::vector<double> instants = {};
};

}  // namespace pleuel
