#pragma once

#include "optimization/design_problem.hpp"

namespace pleuel {

/// A design problem as the backends see it: each limit on a peak over time stands once for each of
/// several windows of time. The maximum over the whole time has a kink wherever two peaks tie, and
/// optimizers drive designs right onto such ties (both peaks reach the limit); the peaks of the
/// windows are smooth, and the optimum is an ordinary point with two active rows.
class PeakProblem : public Problem {
 public:
  /// @param windows  of equal length, at least 1
  PeakProblem(DesignProblem& problem, int windows);

  /// Begins at another design, moved into the bounds.
  void start_from(const Eigen::VectorXd& x);

  const std::vector<Variable>& variables() const override { return variables_; }
  const std::vector<Constraint>& constraints() const override { return rows_; }
  std::string objective_name() const override { return problem_.objective_name(); }
  Evaluation evaluate(const Eigen::VectorXd& x, Request request) override;

  /// The constraint of the file that each row is of.
  const std::vector<std::size_t>& constraint_of_row() const { return constraint_of_row_; }

  /// Values of the rows as values of the constraints: the worst of each.
  Eigen::VectorXd fold_values(const Eigen::VectorXd& rows) const;
  /// Multipliers of the rows as those of the constraints: their sums.
  Eigen::VectorXd fold_multipliers(const Eigen::VectorXd& rows) const;

 private:
  /// The constraints, those on peaks window by window.
  std::vector<ConstraintRow> rows_of(const Analysis& analysis) const;

  DesignProblem& problem_;
  int windows_;
  std::vector<Variable> variables_;
  std::vector<Constraint> rows_;
  std::vector<std::size_t> constraint_of_row_;
  std::vector<bool> is_split_;  ///< constraint by constraint
};

}  // namespace pleuel
