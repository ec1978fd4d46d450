#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

/// Decompositions of dense matrices. Each takes the compiler seconds wherever it is used, so that
/// they are compiled here, once.
namespace pleuel {

/// Q R = A P with |R_11| ≥ |R_22| ≥ …: Householder QR with column pivoting (Golub & Van Loan,
/// Matrix Computations, §5.4.2). Columns that depend on others come last.
class PivotedQr {
 public:
  /// Pivots that are smaller than round-off makes them are zero.
  explicit PivotedQr(const Eigen::MatrixXd& matrix);
  /// @param threshold  pivots that are smaller, relative to the largest, are zero.
  PivotedQr(const Eigen::MatrixXd& matrix, double threshold);
  ~PivotedQr();

  Eigen::Index rank() const;
  /// The columns of A in the order of their pivots.
  std::vector<int> order() const;
  /// |R_ii|, as many as A has rows or columns.
  Eigen::VectorXd pivots() const;
  Eigen::MatrixXd q() const;
  /// An orthonormal basis of what is normal to all columns of A: { y : Aᵀ y = 0 }.
  Eigen::MatrixXd normal_space() const;
  /// A z ≈ b in least squares, zero for columns that depend on others.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

 private:
  std::unique_ptr<Eigen::ColPivHouseholderQR<Eigen::MatrixXd>> qr_;
};

/// P A = L U of a square matrix with partial pivoting.
class DenseLu {
 public:
  explicit DenseLu(const Eigen::MatrixXd& matrix);
  ~DenseLu();

  /// A⁻¹ b, columns as one block.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;
  /// A⁻ᵀ b.
  Eigen::MatrixXd solve_transposed(const Eigen::MatrixXd& b) const;
  /// Estimate of 1/condition in the 1-norm.
  double reciprocal_condition() const;

 private:
  std::unique_ptr<Eigen::PartialPivLU<Eigen::MatrixXd>> lu_;
};

/// Of all z that make ‖A z − b‖ least the shortest one, by a complete orthogonal decomposition.
Eigen::VectorXd least_norm_solution(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& b);

/// Eigenvalues in rising order and their vectors as columns.
struct SymmetricModes {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// A φ = μ φ of a symmetric A (its lower triangle counts).
SymmetricModes symmetric_modes(const Eigen::MatrixXd& a);
/// A φ = μ B φ of a symmetric A and a positive definite B; φᵀ B φ = 1.
SymmetricModes symmetric_modes(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// The same of Hermitian matrices.
struct HermitianModes {
  Eigen::VectorXd values;
  Eigen::MatrixXcd vectors;
};

HermitianModes hermitian_modes(const Eigen::MatrixXcd& a, const Eigen::MatrixXcd& b);

/// The eigenvalues alone, in rising order.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& a);
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Of any square matrix.
Eigen::VectorXcd eigenvalues_of(const Eigen::MatrixXd& matrix);

/// Whether a symmetric matrix has a Cholesky factor.
bool is_positive_definite(const Eigen::MatrixXd& matrix);

}  // namespace pleuel
