#pragma once

#include <memory>
#include <vector>

#include <Eigen/SparseCore>

namespace pleuel {

/// Sparse LU of matrices with one fixed pattern (KLU: Davis & Palamadai Natarajan 2010): the
/// ordering and pivots once, then numeric refactorisation with the old pivots (pivoted_factors.hpp).
/// Rows and columns are scaled by powers of two. Pivots and scales are chosen anew where the
/// condition has become worse by a lot, pivots also where the residual of a solution shows that
/// they are poor: first anew, then without regard to fill.
class LinearSolver {
 public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

  /// @param first  unknowns that are eliminated before all others, in an order of minimum degree
  ///               (CAMD: Amestoy, Davis & Duff 2004): the elastic coordinates of a mechanism
  ///               (Mechanism::elastic). Eliminated among them, a frame, which is coupled to all
  ///               elastic coordinates of its body, would fill in all of them. None: KLU's own
  ///               order.
  explicit LinearSolver(const Matrix& pattern, const std::vector<int>& first = {});
  ~LinearSolver();
  LinearSolver(LinearSolver&&) noexcept;

  /// @returns false if the matrix is singular or not finite
  [[nodiscard]] bool factorize(const Matrix& matrix);

  /// rhs ← A⁻¹ rhs, all columns as one block; one step of iterative refinement where the residual
  /// is more than round-off. Not finite if the matrix turns out to be singular. Allocates only if
  /// the number of columns changes, or with many columns where new pivots have other fill.
  void solve(Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> rhs);

  /// rhs ← A⁻ᵀ rhs, likewise.
  void solve_transposed(Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> rhs);

  /// Whether backward_error() is below 1e-10. If not, no choice of pivots helped: Newton's method
  /// may correct that, but nothing else will.
  bool is_accurate() const;

  /// max |b − A x| / (max |a_ij| Σ|x| + max |b|) of the scaled equations in the last solution; of
  /// several columns that of their sum, each divided by the denominator.
  double backward_error() const;

  /// Cheap estimate of 1/condition of the scaled matrix from the pivots of the last factorisation.
  double reciprocal_condition() const;

  /// Estimate of the condition number of the scaled matrix in the 1-norm (Higham & Tisseur 2000),
  /// at the cost of some ten solutions.
  double condition() const;

  /// Of the determinant of the matrix that was factorized last: 1 or −1.
  int determinant_sign() const;

  int factorizations() const;

  /// Entries of L and U in the last factorisation: what refactorisation and solution cost.
  int factor_entries() const;

  /// Diagonal entries are pivots if they are as large as this part of the largest in their column.
  /// KLU's own 0.001 leaves backward errors of 1e-14 and more in its own order, so that many
  /// solutions have to be refined; with 0.1 hardly any has, at about the same fill.
  static constexpr double usual_threshold = 0.1;
  /// The same where the order of elimination is ours. Larger thresholds leave it more often and so
  /// fill in: 0.1 makes a step with 256 elements a member six times slower. Hardly any solution has
  /// to be refined.
  static constexpr double ordered_threshold = 1e-3;

  /// All that past factorisations leave behind: the scaled matrix whose pivots are in use, its
  /// scales, and how they were chosen. With the pivots of another solver, factorisations repeat
  /// those of that one bit by bit.
  struct Pivots {
    Eigen::VectorXd row_scale, column_scale, values;
    double threshold = usual_threshold;  ///< of pivots on the diagonal
  };
  Pivots pivots() const;
  void use_pivots(const Pivots& pivots);
  /// How often pivots were chosen: they are the same while it is.
  int pivot_choices() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace pleuel
