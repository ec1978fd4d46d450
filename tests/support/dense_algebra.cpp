#include "tests/support/dense_algebra.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <unsupported/Eigen/MatrixFunctions>

namespace pleuel::test {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd solve_dense(const MatrixXd& a, const MatrixXd& b) {
  return a.fullPivLu().solve(b);
}

MatrixXd least_squares(const MatrixXd& a, const MatrixXd& b) {
  return a.colPivHouseholderQr().solve(b);
}

Eigen::Index rank_of(const MatrixXd& a) {
  return a.fullPivLu().rank();
}

Pseudoinverse pseudoinverse(const MatrixXd& a, double threshold) {
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> decomposition(a);
  decomposition.setThreshold(threshold);
  return {decomposition.pseudoInverse(), decomposition.rank()};
}

MatrixXd orthonormal_columns(const MatrixXd& a) {
  return MatrixXd(a.householderQr().householderQ()).leftCols(a.cols());
}

Eigen::VectorXcd eigenvalues(const MatrixXd& a) {
  return Eigen::EigenSolver<MatrixXd>(a, /*computeEigenvectors=*/false).eigenvalues();
}

VectorXd eigenvalues_of_symmetric(const MatrixXd& a) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(a, Eigen::EigenvaluesOnly).eigenvalues();
}

VectorXd eigenvalues_of_symmetric(const MatrixXd& a, const MatrixXd& b) {
  return Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(a, b, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

MatrixXd exponential(const MatrixXd& a) {
  return a.exp();
}

}  // namespace pleuel::test
