#pragma once

#include <memory>

#include <Eigen/SparseCore>

namespace pleuel {

/// L D Lᵀ of a sparse symmetric matrix that need not be definite, by MUMPS (Amestoy, Duff, L'Excellent &
/// Koster 2001), one process.
class SymmetricSolver {
 public:
  /// @param matrix  its lower triangle counts
  /// @throws SimulationError if MUMPS cannot factorize it
  explicit SymmetricSolver(const Eigen::SparseMatrix<double>& matrix);
  ~SymmetricSolver();
  SymmetricSolver(const SymmetricSolver&) = delete;
  SymmetricSolver& operator=(const SymmetricSolver&) = delete;

  /// A⁻¹ b, columns as one block.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;
  /// Pivots that are zero to round-off.
  int null_pivots() const;
  int negative_pivots() const;

 private:
  struct Mumps;
  std::unique_ptr<Mumps> mumps_;
};

}  // namespace pleuel
