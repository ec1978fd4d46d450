#pragma once

#include <memory>

#include "core/mechanism/linear_solver.hpp"

namespace pleuel {

/// The pivots of a solver, shared by all checkpoints between which it did not choose others.
class PivotRecord {
 public:
  using Pivots = std::shared_ptr<const LinearSolver::Pivots>;

  Pivots of(const LinearSolver& solver) {
    if (solver.pivot_choices() != choice_) {
      pivots_ = std::make_shared<LinearSolver::Pivots>(solver.pivots());
      choice_ = solver.pivot_choices();
    }
    return pivots_;
  }

  void restore(const Pivots& pivots, LinearSolver& solver) {
    if (pivots == pivots_ && solver.pivot_choices() == choice_) return;
    solver.use_pivots(*pivots);
    pivots_ = pivots;
    choice_ = solver.pivot_choices();
  }

 private:
  Pivots pivots_;
  int choice_ = -1;  ///< of the solver, with these pivots
};

}  // namespace pleuel
