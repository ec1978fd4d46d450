#pragma once

#include <complex>
#include <vector>

#include <Eigen/Core>

/// Decompositions of dense matrices by LAPACK (Anderson et al. 1999), which is compiled already:
/// those of Eigen are templates that take the compiler seconds wherever they stand. What is made of
/// a matrix that is not finite is not a number.
namespace pleuel {

/// Q R = A P with |R_11| ≥ |R_22| ≥ …: Householder QR with column pivoting (Golub & Van Loan,
/// Matrix Computations, §5.4.2). Columns that depend on others come last.
class PivotedQr {
 public:
  /// Pivots that are smaller than round-off makes them are zero.
  explicit PivotedQr(const Eigen::MatrixXd& matrix);
  /// @param threshold  pivots that are smaller, relative to the largest, are zero.
  PivotedQr(const Eigen::MatrixXd& matrix, double threshold);

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
  Eigen::MatrixXd qr_;       ///< R above, Householder vectors below the diagonal
  Eigen::VectorXd factors_;  ///< of the Householder reflections
  std::vector<int> order_;   ///< counts from one
  double threshold_;
};

/// P A = L U of a square matrix with partial pivoting.
template <class Scalar>
class Lu {
 public:
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

  explicit Lu(const Matrix& matrix);

  /// A⁻¹ b, columns as one block.
  Matrix solve(const Matrix& b) const;
  /// A⁻ᵀ b.
  Matrix solve_transposed(const Matrix& b) const;
  /// Estimate of 1/condition in the 1-norm.
  double reciprocal_condition() const;

 private:
  Matrix solve(char operation, const Matrix& b) const;

  Matrix lu_;
  std::vector<int> rows_;
  double norm_;
};

using DenseLu = Lu<double>;
using ComplexLu = Lu<std::complex<double>>;

/// A = L Lᵀ of a symmetric matrix (its lower triangle counts).
class Cholesky {
 public:
  Cholesky() = default;
  explicit Cholesky(const Eigen::MatrixXd& matrix);

  bool is_positive_definite() const { return is_positive_definite_; }
  /// A⁻¹ b, columns as one block.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;
  /// L⁻¹ b.
  Eigen::MatrixXd solve_lower(const Eigen::MatrixXd& b) const;
  const Eigen::MatrixXd& lower() const { return lower_; }

 private:
  Eigen::MatrixXd lower_;
  bool is_positive_definite_ = true;
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

}  // namespace pleuel
