#pragma once

#include "core/scene/response_parts.hpp"
#include "optimization/design/design_problem.hpp"
#include "optimization/design/peak_windows.hpp"
#include "optimization/phase_one.hpp"

namespace pleuel {

/// A design problem as the backends see it: each limit on a peak over time stands once for each of
/// several windows of time. The maximum over the whole time has a kink wherever two peaks tie, and
/// optimizers drive designs right onto such ties (both peaks reach the limit); the peaks of the
/// windows are smooth, and the optimum is an ordinary point with two active rows.
///
/// An objective that is itself a peak becomes a variable t more, in the form
///
///     minimize t   subject to   peak of each window ≤ t
///
/// A design of this problem is (x, t) then, and the rows peak − t ≤ 0 follow those of the limits.
/// Of the worst of several load cases all have one t, whether they are peaks or not: a tie of two
/// cases is an ordinary point, too. Of a sum over cases each peak has a t of its own, and Σ w t is
/// minimized.
///
/// So does one that is the largest of several responses, max(a, b, …), be they peaks or not: the rows
/// of all of them follow. An upper limit on such a response is one on each of them; what is maximized
/// and lower limits likewise by min(a, b, …).
///
/// The same holds for the place where a peak is: the largest stress of a whole beam has a kink
/// wherever it moves from one segment to another. A limit on it stands once for each window at each
/// place (place_count()), with fewer windows where there are many places, or many limits.
///
/// A response that is made from several cases stands as one row, unless it is such a largest one:
/// max(a[slow], b[fast]) is split into rows of these cases.
///
/// All rows bear the names of what they are peaks of: windows and places are nothing that a user
/// knows.
class PeakProblem : public Problem {
 public:
  /// Which peaks are told apart: those of the limits and the objective, or of the limits only. Then
  /// a design is x, and nothing is evaluated before it is asked for.
  enum class Scope { objective_and_limits, limits };

  /// @param windows  of equal length, at least 1
  /// @param start    of the design, moved into the bounds; by default that of the file. Where the
  ///                 objective is a peak it is evaluated, with gradients.
  PeakProblem(DesignProblem& problem, int windows);
  PeakProblem(DesignProblem& problem, int windows, const Eigen::VectorXd& start,
              Scope scope = Scope::objective_and_limits);

  const std::vector<Variable>& variables() const override { return variables_; }
  const std::vector<Constraint>& constraints() const override { return rows_; }
  std::string objective_name() const override { return problem_.objective_name(); }
  std::string variable_text(std::size_t variable, double value) const override;
  std::string constraint_text(std::size_t constraint, double value) const override;
  Evaluation evaluate(const Eigen::VectorXd& x, Request request) override;

  /// Whether any row stands for one window of time of several.
  bool divides_time() const;

  /// The constraint of the file that each row is of; none for those of the objective.
  const ConstraintOfRow& constraint_of_row() const { return constraint_of_row_; }

  /// How much of the objective is that of each case, by the multipliers of the rows: of the worst
  /// case shares that add up to 1. Empty where t does not stand for several cases.
  Eigen::VectorXd objective_shares(const Eigen::VectorXd& multipliers) const;

  /// x without t.
  Eigen::VectorXd design_of(const Eigen::VectorXd& x) const {
    return x.head(problem_.variables().size());
  }
  /// The objective of the file: with t, its highest window.
  double fold_objective(double objective, const Eigen::VectorXd& rows) const;
  /// Values of the rows as values of the constraints: the worst of each.
  Eigen::VectorXd fold_values(const Eigen::VectorXd& rows) const {
    return worst_values(constraint_of_row_, rows, problem_.constraints());
  }
  /// Multipliers of the rows as those of the constraints: their sums.
  Eigen::VectorXd fold_multipliers(const Eigen::VectorXd& rows) const;

 private:
  /// An epigraph variable t, which bounds the objective of some cases, and what it counts in the objective.
  struct EpigraphVariable {
    double weight = 1.0;
    std::vector<RowSource> sources = {};
    Eigen::Index first_row = 0, rows = 0;
  };

  void add_rows(const RowSource& source, std::optional<std::size_t> constraint,
                const Constraint& limits);
  void bound_objective();
  void add_epigraph_variable(EpigraphVariable bound);
  void start_epigraph_variables();
  void name_rows();

  DesignProblem& problem_;
  int windows_;
  std::vector<Variable> variables_;
  std::vector<Constraint> rows_;
  ConstraintOfRow constraint_of_row_;
  NamedRows named_rows_;                  ///< all of them, as they are evaluated
  std::vector<EpigraphVariable> bounds_;  ///< of the objective
};

}  // namespace pleuel
