#pragma once

#include <Eigen/Core>

/// Decompositions of dense matrices for tests: by Eigen, apart from those of the code under test
/// (core/base/dense_solvers.hpp). Each takes the compiler seconds wherever it is used, so that they
/// are compiled here, once.
namespace pleuel::test {

/// A⁻¹ b by LU with full pivoting, columns of b as one block.
Eigen::MatrixXd solve_dense(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// x that makes ‖A x − b‖ least, columns of b as one block.
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// How many rows, or columns, are independent.
Eigen::Index rank_of(const Eigen::MatrixXd& a);

/// A⁺: A⁺ b is the shortest of all x that make ‖A x − b‖ least.
struct Pseudoinverse {
  Eigen::MatrixXd matrix;
  Eigen::Index rank;
};
/// @param threshold  pivots that are smaller, relative to the largest, are zero.
Pseudoinverse pseudoinverse(const Eigen::MatrixXd& a, double threshold);

/// As many columns as A has, orthonormal, with the span of those of A.
Eigen::MatrixXd orthonormal_columns(const Eigen::MatrixXd& a);

/// Of any square matrix.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& a);

/// Of a symmetric A, in rising order.
Eigen::VectorXd eigenvalues_of_symmetric(const Eigen::MatrixXd& a);
/// μ of A φ = μ B φ, of a symmetric A and a positive definite B, in rising order.
Eigen::VectorXd eigenvalues_of_symmetric(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// I + A + A²/2 + …, by its series for A/2ᵏ, squared k times.
Eigen::MatrixXd exponential(const Eigen::MatrixXd& a);

}  // namespace pleuel::test
