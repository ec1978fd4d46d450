#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "optimization/problem.hpp"
#include "optimization/result.hpp"
#include "optimization/scaling.hpp"

/// Phase 1 of a search: the limits alone count, whatever the objective says.
namespace pleuel {

/// The constraint that each component of a problem with more of them stands for; none of components that stand
/// for something else.
using ConstraintOfRow = std::vector<std::optional<std::size_t>>;

/// Of a problem whose components are its constraints.
ConstraintOfRow own_constraints(const Problem& problem);

/// The worst component of each constraint: a value for each.
Eigen::VectorXd worst_values(const ConstraintOfRow& constraint_of_row, const Eigen::VectorXd& rows,
                             const std::vector<Constraint>& limits);

/// The limits of a problem as components that are smooth in the design: a limit may have several, such as the
/// peaks of parts of it. The variables are those of the problem.
struct LimitRows {
  Problem* problem = nullptr;
  ConstraintOfRow constraint_of_row;
};

/// The first design with gradients among those on the way from the start to the middle of the bounds
/// and, after them, others spread between the bounds.
std::optional<Eigen::VectorXd> evaluable_design(Problem& problem);

/// A design within the limits, restored from `best` or, where that fails, from
/// those of designs spread between the bounds that break the limits least.
/// @param magnitudes   of the constraints of `limits`, see scaling.hpp
std::optional<Eigen::VectorXd> design_within_limits(const LimitRows& rows, const Problem& limits,
                                                    const Eigen::VectorXd& magnitudes,
                                                    const Eigen::VectorXd& best);

/// Minimizes the largest relative violation of all limits from a design on, by gradients; and where
/// that is not 0, for each limit in the conflict (six at most) what it would have to be if all
/// others were kept. Each is an optimization of its own, a local one.
/// @param start  can be evaluated, with gradients
LeastViolation find_least_violation(const LimitRows& rows, const std::vector<Constraint>& limits,
                                    const Eigen::VectorXd& start, int iterations);

/// ψ: a relative violation g > 0 as ln(1 + g), g ≤ 0 as it is. Smooth, and it grows with g: what is
/// least in g is least in ψ. For a limit on stress ψ is ln(σ/σ_allow), nearly linear in the
/// logarithms of sizes, however far the design is outside.
double damped_violation(double violation);
/// dψ/dg
double damped_violation_slope(double violation);

/// Phase 1, how far limits have to give: some of them are elastic, the others hold.
///
///     minimize z   subject to   ψ(g) ≤ z for elastic limits,   g ≤ 0 for all others,   z ≥ 0
///
/// (its rows as 1 + ψ − z ≤ 1: relative violations stay what they are). A design of it is (x, z). With all limits
/// elastic its optimum is the design of least largest violation, and the multipliers of its rows, which add up to
/// 1, name the limits that are in conflict there. With one limit elastic it is what this limit has to give if all
/// others hold.
class PhaseOneProblem : public Problem {
 public:
  /// @param problem     must outlive this
  /// @param is_elastic  one a constraint
  /// @param start       x, where `at_start` is its evaluation
  /// @param magnitudes  C, one a constraint
  PhaseOneProblem(Problem& problem, const std::vector<bool>& is_elastic,
                  const Eigen::VectorXd& start, const Evaluation& at_start,
                  const Eigen::VectorXd& magnitudes);

  const std::vector<Variable>& variables() const override { return variables_; }
  const std::vector<Constraint>& constraints() const override { return rows_; }
  std::string objective_name() const override { return "violation"; }
  Evaluation evaluate(const Eigen::VectorXd& xz, Request request) override;

  /// x of (x, z).
  Eigen::VectorXd design_of(const Eigen::VectorXd& xz) const { return xz.head(xz.size() - 1); }
  /// The limit of each row.
  const std::vector<LimitSide>& sides() const { return sides_; }

 private:
  Problem& problem_;
  std::vector<Variable> variables_;
  std::vector<Constraint> rows_;
  std::vector<LimitSide> sides_;
  std::vector<bool> is_elastic_;  ///< row by row
};

/// What a restoration may cost.
struct RestorationBudget {
  int gradients = 25;
  int evaluations = 60;
};

/// Leads a design into the limits, whatever the objective says, by the Levenberg–Marquardt method
/// on the squares of violations:
///
///     minimize Σ max(0, ψ(g) + margin)²     (ψ: damped_violation())
///
/// in the logarithms of variables with positive bounds: there ψ of stresses and deflections is
/// nearly linear in sizes. Each step minimizes the linearised sum within a box, the trust region,
/// which a failed evaluation or a step that does not help makes smaller.
/// @returns a design that exceeds no limit, and of equalities none by more than 1e-7; nothing if it ends
///          elsewhere, or if the start, or its gradients, cannot be evaluated
std::optional<Eigen::VectorXd> restore_limits(Problem& problem, const Eigen::VectorXd& start,
                                              const RestorationBudget& budget = {});

/// Limits r + A d ≤ 0 along a step d: residuals r and their slopes A (limits × variables).
struct LinearizedLimits {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd slopes;

  /// Σ max(0, r + A d)²
  double sum(const Eigen::VectorXd& step) const {
    return (residuals + slopes * step).cwiseMax(0.0).squaredNorm();
  }
};

/// The step that meets the limits as well as can be in the box −down ≤ d ≤ up,
///
///     argmin Σ max(0, r + A d)² + w² ‖max(0, d − up)‖² + w² ‖max(0, −down − d)‖² + λ ‖d‖²
///
/// with sides of the box so heavy (w = 30) that little is cut off in the end, and a λ = 1e-4 that
/// makes the step unique. A convex function of quadratic pieces: Newton's method with the second
/// derivatives of the piece at hand and an exact line search ends after finitely many steps
/// (Mangasarian, A finite Newton method for classification, 2002); each costs
/// O(limits × variables² + variables³).
Eigen::VectorXd violation_step(const LinearizedLimits& limits, const Eigen::VectorXd& down,
                               const Eigen::VectorXd& up);

}  // namespace pleuel
