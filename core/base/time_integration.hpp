#pragma once

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

}  // namespace pleuel
