#pragma once

#include <vector>

#include "core/response/signal.hpp"
#include "core/system/system.hpp"

namespace pleuel {

/// The residual R of some terms of a system, and gradients of combinations of its rows.
class TermProduct {
 public:
  /// @param terms  of the system; must outlive this
  TermProduct(std::vector<Term*> terms, const System& system);

  /// R, n + m entries; valid until the next call.
  const Eigen::VectorXd& residual(const State& state, ConstraintLevel level);

  /// gradient += ∂(rowsᵀ R)/∂(…) at fixed rows.
  /// @param rows  n + m entries
  void add_gradient(const State& state, ConstraintLevel level, const Eigen::VectorXd& rows,
                    SignalGradient& gradient);

 private:
  std::vector<Term*> terms_;
  std::vector<EntryList> entries_;  ///< one a term
  Eigen::VectorXd residual_;
  Eigen::MatrixXd design_;  ///< scratch, (n + m) × variables
  std::vector<double> values_;
};

}  // namespace pleuel
