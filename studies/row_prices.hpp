#pragma once

#include "optimization/design/margin_problem.hpp"
#include "optimization/design/peak_problem.hpp"

/// What the rows of a problem, limits and peaks of the objective window by window, are worth at a
/// design.
namespace pleuel {

/// A design with its rows and their gradients. Its parts refer to each other.
struct DesignRows {
  /// @param windows  of time that peaks are split into
  DesignRows(const ProblemFile& problem, const Eigen::VectorXd& x, int windows, int threads,
             Request request = Request::values_and_gradients);
  DesignRows(const DesignRows&) = delete;

  DesignProblem design;
  PeakProblem peaks;
  std::unique_ptr<Problem> robust;  ///< the peaks with their margins, if there are any
  Problem& rows;
  Eigen::VectorXd x;  ///< with the peak that is minimized, if one is
  Evaluation evaluation;
};

/// So many windows that no two peaks which tie at a design share one. Windows have so many steps
/// each: where steps follow the local error they mean nothing, and it is one.
int windows_at(const ProblemFile& problem, const Eigen::VectorXd& x, int threads);

/// Multipliers of a design by the audit (kkt_audit.hpp), row by row.
struct RowPrices {
  /// @throws InputError if the problem has no variables or no objective
  /// @throws SimulationError
  RowPrices(const ProblemFile& problem, const Eigen::VectorXd& x, int windows, int threads);

  /// f + Σ μ_j c_j of another problem at the design, with these multipliers. How it differs between
  /// two problems is, to first order, how their optima do (envelope theorem). Where a peak is
  /// minimized the peaks are among the rows.
  /// @pre  the steps of the other problem are equal if there are several windows
  /// @throws SimulationError
  double lagrangian(const ProblemFile& other) const;

  Eigen::VectorXd design;
  int windows, threads;
  DesignRows at;
  Eigen::VectorXd scales;       ///< magnitudes of the rows
  Eigen::VectorXd multipliers;  ///< of the rows: 0 where a limit has slack
  Eigen::VectorXd bound_multipliers;
  double residual = 0.0;  ///< relative: how well the multipliers explain the design
};

/// A design of a problem, and what changes of the problem are worth there if it is an optimum.
class PricedDesign {
 public:
  /// The start of the problem has no prices; another design has if multipliers explain it (KKT
  /// residual of at most 1e-2).
  PricedDesign(const ProblemFile& problem, const Eigen::VectorXd& x);

  const Eigen::VectorXd& x() const { return x_; }

  /// RowPrices::lagrangian(); none without prices, where the problem cannot be simulated, or where
  /// steps that follow the local error leave no windows to compare.
  std::optional<double> lagrangian(const ProblemFile& other) const;

  /// What the optimum changes by from one problem to another [unit of the objective].
  std::optional<double> change(const std::optional<double>& before, const ProblemFile& after) const;

 private:
  Eigen::VectorXd x_;
  bool has_equal_steps_;
  std::unique_ptr<RowPrices> prices_;
};

}  // namespace pleuel
