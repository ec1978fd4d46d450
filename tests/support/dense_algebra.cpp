#include "tests/support/dense_algebra.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

namespace pleuel::test {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd solve_dense(const MatrixXd& a, const MatrixXd& b) {
  return a.fullPivLu().solve(b);
}

MatrixXd least_squares(const MatrixXd& a, const MatrixXd& b) {
  return a.completeOrthogonalDecomposition().solve(b);
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
  int halvings = 0;
  MatrixXd small = a;
  for (; small.cwiseAbs().maxCoeff() * double(a.rows()) > 0.5; ++halvings) small /= 2.0;
  constexpr int terms = 16;  // 0.5¹⁶/16! is below round-off
  MatrixXd result = MatrixXd::Identity(a.rows(), a.cols()), term = result;
  for (int k = 1; k <= terms; ++k) {
    term = term * small / double(k);
    result += term;
  }
  for (int k = 0; k < halvings; ++k) result = result * result;
  return result;
}

}  // namespace pleuel::test
