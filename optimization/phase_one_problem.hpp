#pragma once

#include <vector>

#include "optimization/problem.hpp"
#include "optimization/scaling.hpp"

namespace pleuel {

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

}  // namespace pleuel
