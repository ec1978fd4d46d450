#pragma once

#include <optional>
#include <string>

#include "optimization/evaluation_cache.hpp"
#include "optimization/kkt_audit.hpp"

namespace pleuel {

/// What separates right answers from wrong ones.
struct Tolerances {
  /// Largest relative KKT residual. On problems with known optimum it was at most 1.5e-4 at right
  /// points and at least 0.06 at wrong ones; raise it only for noisy simulations.
  double kkt_residual = 1e-3;
  /// Largest residual of one variable relative to the terms that make it up (kkt_audit.hpp). The
  /// part of the objective that hangs on a variable has there a curvature of about its terms T, so
  /// that a residual ρ leaves ½ ρ² T to be gained: at most 10⁻⁴ of that part, however small it is.
  double variable_residual = 1e-2;
  /// Largest amount, relative to the limit, by which a limit may be exceeded.
  double violation = 1e-4;
  /// Largest relative difference between gradients and differences of values; more than the
  /// residual, because differences carry the noise of the simulation.
  double gradient = 5e-3;
  /// Largest gain, relative to the objective, that a design nearby may offer, or that is estimated
  /// to be left; as small as the violation that is allowed, and above the noise of simulations.
  double gain = 1e-4;
};

/// A design and what our audit says of it.
struct Verdict {
  Status status = Status::stalled;
  std::string message;     ///< a sentence
  EvaluatedDesign design;  ///< with gradients
  KktAudit audit;
  bool gradients_are_disproved = false;  ///< by differences, where all else is well
  /// What is estimated to be left to the local optimum, relative to the objective: slack and
  /// violation at their price, and what the remaining slope may gain (neighbourhood.hpp). Known
  /// of designs that fulfil the conditions of first order.
  double gain_left = 0.0;
  /// A better design nearby: the conditions of first order hold, but at no minimum.
  std::optional<Eigen::VectorXd> better_neighbour;
};

/// Audits a design on the true values of the problem, in this order: limits, KKT conditions of all
/// variables together and of each one, gradients against differences, and whether a design nearby
/// is better (neighbourhood.hpp) or the estimate of what is left too large; each only if all before
/// is well. `verified` is a local optimum as far as these can see: not a proof,
/// and no word on other optima further away.
/// @param design  with gradients.
/// @param start   evaluation of the first design, with gradients.
Verdict judge(EvaluationCache& cache, const EvaluatedDesign& design, const Evaluation& start,
              const Tolerances& tolerances);

/// How far the gradients that an audit relied on are from differences of the values.
struct GradientCheck {
  bool is_possible = false;  ///< false: the designs beside this one could not be evaluated
  double error = 0.0;        ///< relative to the gradient scale of the audit
  std::string worst;         ///< name of the objective or constraint with the largest error
};

/// Directional derivatives along generic directions d by the one-sided formula of second order,
///
///     ∂f/∂d ≈ (−3 f(x) + 4 f(x + h d) − f(x + 2 h d)) / 2h,   h |dᵢ| ≤ 10⁻³ |xᵢ|
///
/// against the gradients of the objective and of every constraint that has a multiplier, weighted
/// with it: what an optimum found with wrong gradients, or at a kink, cannot pass. Three directions
/// at 120° to each other in one plane (inwards at bounds), so that both sides of a kink are seen;
/// opposite ones if there is one variable. Where the error along one is not good enough, a tenth of
/// h is tried, since values that ring with the design have large third derivatives: the smaller
/// error counts. Six evaluations of values, twice as many where that happens. Errors across that
/// plane are not seen. The error estimates ‖s ∘ (error of ∇f)‖₂: a generic direction sees 1/√n of
/// it.
GradientCheck check_gradients(EvaluationCache& cache, const EvaluatedDesign& design,
                              const KktAudit& audit, double good_enough);

}  // namespace pleuel
