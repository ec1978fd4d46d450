#pragma once

#include <memory>
#include <optional>

#include "optimization/design/design_problem.hpp"
#include "optimization/design/margin_problem.hpp"
#include "optimization/design/peak_problem.hpp"

/// What the rows of a problem, limits and peaks of the objective window by window, are worth at a
/// design.
namespace pleuel {

/// A design with its rows and their gradients.
class DesignRows {
 public:
  /// @param windows  of time that peaks are split into
  DesignRows(const ProblemFile& problem, const Eigen::VectorXd& x, int windows, int threads,
             Request request = Request::values_and_gradients);
  DesignRows(const DesignRows&) = delete;  // its parts refer to each other

  Problem& rows() { return robust_ ? *robust_ : peaks_; }
  const Problem& rows() const {
    if (robust_) return *robust_;
    return peaks_;
  }
  const PeakProblem& peaks() const { return peaks_; }
  /// With the peak that is minimized, if one is.
  const Eigen::VectorXd& x() const { return x_; }
  const Evaluation& evaluation() const { return evaluation_; }

 private:
  DesignProblem design_;
  PeakProblem peaks_;
  std::unique_ptr<Problem> robust_;
  Eigen::VectorXd x_;
  Evaluation evaluation_;
};

/// So many windows that no two peaks which tie at a design share one. Windows have so many steps
/// each: where steps follow the local error they mean nothing, and it is one.
int windows_at(const ProblemFile& problem, const Eigen::VectorXd& x, int threads);

/// Multipliers of a design by the audit (kkt_audit.hpp), row by row.
class RowPrices {
 public:
  /// @throws InputError if the problem has no variables or no objective
  /// @throws SimulationError
  RowPrices(const ProblemFile& problem, const Eigen::VectorXd& x, int windows, int threads);

  const DesignRows& rows() const { return rows_; }
  /// Relative: how well the multipliers explain the design.
  double residual() const { return residual_; }
  /// Of the rows: 0 where a limit has slack.
  const Eigen::VectorXd& multipliers() const { return multipliers_; }
  const Eigen::VectorXd& bound_multipliers() const { return bound_multipliers_; }
  /// Magnitudes of the rows.
  const Eigen::VectorXd& scales() const { return scales_; }

  /// f + Σ μ_j c_j of another problem at the design, with these multipliers. How it differs between
  /// two problems is, to first order, how their optima do (envelope theorem). Where a peak is
  /// minimized the peaks are among the rows.
  /// @pre  the steps of the other problem are equal if there are several windows
  /// @throws SimulationError
  double lagrangian(const ProblemFile& other) const;

 private:
  Eigen::VectorXd design_;
  int windows_, threads_;
  DesignRows rows_;
  Eigen::VectorXd scales_, multipliers_, bound_multipliers_;
  double residual_ = 0.0;
};

/// A design of a problem, and what changes of the problem are worth there if it is an optimum.
class PricedDesign {
 public:
  /// The start of the problem has no prices; another design has if multipliers explain it (KKT
  /// residual of at most 1e-2).
  PricedDesign(const ProblemFile& problem, const Eigen::VectorXd& x);

  const Eigen::VectorXd& x() const { return x_; }
  bool has_prices() const { return prices_ != nullptr; }

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
