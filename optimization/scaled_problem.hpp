#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/base/int_size.hpp"
#include "optimization/evaluation_cache.hpp"
#include "optimization/problem.hpp"

/// Natural magnitudes of variables, constraints, and objective: what "relative" and "of order one"
/// mean in this folder.
namespace pleuel {

/// Magnitude s of each variable near the design x, for the backends: its own, or else |xᵢ|, but at
/// least a tenth of the range between its bounds and at most all of it; without finite bounds at
/// least |start|, or 1 if both are 0. Always positive.
Eigen::VectorXd variable_scales(const Problem& problem, const Eigen::VectorXd& x);

/// The same for the audit, with at least a hundredth of the range: a step of s is a change of a
/// small variable that an engineer would call large. Variables without finite bounds share the
/// largest of their magnitudes, since nothing says that one of them near 0 is meant to be small.
Eigen::VectorXd local_scales(const Problem& problem, const Eigen::VectorXd& x);

/// Magnitude C of each constraint: its larger finite limit, so that (c − upper)/C is σ/σ_allow − 1.
/// Where the limits are 0, the change of c with the variables, ‖s ∘ ∇c‖∞; where that vanishes too,
/// |c|, or 1. Always positive.
/// @param evaluation  at x, with gradients.
/// @param scales      s of variable_scales().
Eigen::VectorXd constraint_scales(const Problem& problem, const Evaluation& evaluation,
                                  const Eigen::VectorXd& scales);

/// s ∘ ∇f, the change of the objective with each variable; 0 for fixed variables.
Eigen::VectorXd scaled_objective_gradient(const Problem& problem, const Evaluation& evaluation,
                                          const Eigen::VectorXd& scales);

/// Magnitude F of the objective: max(|f|, ‖s ∘ ∇f‖∞), or 1 where both vanish. Always positive.
double objective_scale(const Problem& problem, const Evaluation& evaluation,
                       const Eigen::VectorXd& scales);

/// |f|, but not nothing where f vanishes at the optimum: at least a thousandth of that of the start.
double objective_value_scale(const Evaluation& evaluation, const Evaluation& start);

/// What a design is, with gradients; nullptr where it cannot be evaluated. Valid until the next call.
using EvaluateBeside = std::function<const Evaluation*(const Eigen::VectorXd& x)>;

/// Curvature of the objective: how far s ∘ ∇f changes with the variables, by the gradient of a design beside x.
/// A sum of squares may vanish at its optimum, and its slope with it; this says what is much of it. Zero where
/// nothing is known.
/// @param at  evaluation of x, with gradients
double objective_curvature(const Problem& problem, const Eigen::VectorXd& x, const Evaluation& at,
                           const EvaluateBeside& evaluate);

/// One side of a limit as g = sign · (c − limit) / C ≤ 0.
struct LimitSide {
  std::size_t constraint = 0;
  double sign = 1.0;
  double limit = 0.0;
  double magnitude = 1.0;  ///< C

  double violation(const Eigen::VectorXd& constraints) const {
    return sign * (constraints[constraint] - limit) / magnitude;
  }
};

/// Both sides of all limits that are finite.
/// @param magnitudes  C, one a constraint
std::vector<LimitSide> limit_sides(const Problem& problem, const Eigen::VectorXd& magnitudes);

/// max over constraints of the amount by which c leaves its limits, divided by C; 0 if none does.
double max_violation(const Problem& problem, const Eigen::VectorXd& constraints,
                     const Eigen::VectorXd& scales);

/// What a backend sees at y.
struct ScaledEvaluation {
  double objective = 0.0;
  Eigen::VectorXd inequalities;  ///< g ≤ 0
  Eigen::VectorXd equalities;    ///< h = 0
  Eigen::VectorXd objective_gradient;
  Eigen::MatrixXd inequality_jacobian;  ///< inequalities × variables
  Eigen::MatrixXd equality_jacobian;    ///< equalities × variables
};

/// The problem as the backends see it, with numbers of order one and limits in the form they want:
///
///     y = x / s,   f(y) = f / F,   g(y) = ±(c − limit) / C ≤ 0,   h(y) = (c − limit) / C = 0
///
/// with the magnitudes s, F, C. A constraint with two limits gives two rows, one
/// without any gives none; a fixed variable is no variable here. It also says when to stop.
class ScaledProblem {
 public:
  struct Budget {
    int iterations = 0;            ///< of the cache, counted since the start of the run
    int evaluations = 0;           ///< likewise
    int consecutive_failures = 0;  ///< after this many the region is hopeless
    int line_search = 0;           ///< evaluations without gradients in a row: no way down is found
    int patience = 0;              ///< iterations without a better design; 0: any number
  };

  /// @param around   the design whose magnitudes scale the problem, and where the backend starts;
  ///                 with gradients.
  /// @param factors  of s, one a variable, positive; empty: 1.
  ScaledProblem(EvaluationCache& cache, const EvaluatedDesign& around, Budget budget,
                const Eigen::VectorXd& factors = {});

  int variables() const { return int_size(free_); }
  int inequalities() const { return int_size(inequalities_); }
  int equalities() const { return int_size(equalities_); }
  Eigen::VectorXd start() const { return to_scaled(around_); }
  Eigen::VectorXd lower() const { return scaled_bounds(&Variable::lower); }
  Eigen::VectorXd upper() const { return scaled_bounds(&Variable::upper); }

  /// nullopt if the evaluation failed or if the backend should stop. Never throws, since it is
  /// called through C: a fault of the program is kept for rethrow().
  std::optional<ScaledEvaluation> evaluate(const Eigen::VectorXd& y, Request request) noexcept;

  /// The budget is used up or something was thrown: no more evaluations are made.
  bool should_stop() const { return should_stop_; }
  /// The backend asked for a design that is not a number: it has lost its way, and stops.
  bool has_left_numbers() const { return has_left_numbers_; }
  /// Why the last evaluation has no numbers; empty: it has.
  const std::string& failure() const { return cache_.history().back().failure; }
  /// Throws what an evaluation threw, if it did.
  void rethrow() const;

  /// The design of y, exactly within its bounds.
  Eigen::VectorXd to_design(const Eigen::VectorXd& y) const;

 private:
  Eigen::VectorXd scaled_bounds(double Variable::*bound) const;
  void update_stop();
  void see_progress();
  Eigen::VectorXd to_scaled(const Eigen::VectorXd& x) const;
  Eigen::VectorXd values(const std::vector<LimitSide>& rows, const Evaluation& evaluation) const;
  Eigen::MatrixXd jacobian(const std::vector<LimitSide>& rows, const Evaluation& evaluation) const;
  ScaledEvaluation scale(const Evaluation& evaluation) const;

  EvaluationCache& cache_;
  int iterations_ = 0;   ///< of the cache, when gradients were last computed here
  int evaluations_ = 0;  ///< likewise
  /// The best so far, from the start of the run on, and the iteration that found it.
  double best_objective_, best_violation_;
  int best_iteration_ = 0;
  Eigen::VectorXd around_;
  Budget budget_;
  std::vector<Eigen::Index> free_;  ///< the variables that are not fixed
  std::vector<LimitSide> inequalities_, equalities_;
  Eigen::VectorXd variable_scales_;
  double objective_scale_;
  bool should_stop_ = false;
  bool has_left_numbers_ = false;
  std::exception_ptr exception_;
};

}  // namespace pleuel
