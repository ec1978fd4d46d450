#pragma once

#include <memory>

#include <Eigen/SparseCore>

namespace pleuel {

/// Sparse LU of matrices with one fixed pattern (KLU: Davis & Palamadai Natarajan 2010): the
/// ordering once, then numeric refactorisation with the old pivots, re-pivoted when they are poor.
class LinearSolver {
 public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

  explicit LinearSolver(const Matrix& pattern);
  ~LinearSolver();
  LinearSolver(LinearSolver&&) noexcept;

  /// @returns false if the matrix is singular or not finite
  [[nodiscard]] bool factorize(const Matrix& matrix);

  /// rhs ← A⁻¹ rhs, all columns as one block.
  void solve(Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> rhs);

  /// rhs ← A⁻ᵀ rhs.
  void solve_transposed(Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> rhs);

  /// Cheap estimate of 1/condition from the pivots of the last factorisation.
  double reciprocal_condition() const;

  int factorizations() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace pleuel
