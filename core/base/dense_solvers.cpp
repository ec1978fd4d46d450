#include "core/base/dense_solvers.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

namespace pleuel {

PivotedQr::PivotedQr(const Eigen::MatrixXd& matrix)
    : qr_(std::make_unique<Eigen::ColPivHouseholderQR<Eigen::MatrixXd>>(matrix)) {}

PivotedQr::PivotedQr(const Eigen::MatrixXd& matrix, double threshold) : PivotedQr(matrix) {
  qr_->setThreshold(threshold);
}

PivotedQr::~PivotedQr() = default;

Eigen::Index PivotedQr::rank() const {
  return qr_->rank();
}

std::vector<int> PivotedQr::order() const {
  const auto& order = qr_->colsPermutation().indices();
  return {order.begin(), order.end()};
}

Eigen::VectorXd PivotedQr::pivots() const {
  return qr_->matrixQR().diagonal().cwiseAbs();
}

Eigen::MatrixXd PivotedQr::q() const {
  return qr_->householderQ();
}

Eigen::MatrixXd PivotedQr::normal_space() const {
  return q().rightCols(qr_->rows() - rank());
}

Eigen::VectorXd PivotedQr::solve(const Eigen::VectorXd& b) const {
  return qr_->solve(b);
}

DenseLu::DenseLu(const Eigen::MatrixXd& matrix)
    : lu_(std::make_unique<Eigen::PartialPivLU<Eigen::MatrixXd>>(matrix)) {}

DenseLu::~DenseLu() = default;

Eigen::MatrixXd DenseLu::solve(const Eigen::MatrixXd& b) const {
  return lu_->solve(b);
}

Eigen::MatrixXd DenseLu::solve_transposed(const Eigen::MatrixXd& b) const {
  return lu_->transpose().solve(b);
}

double DenseLu::reciprocal_condition() const {
  return lu_->rcond();
}

Eigen::VectorXd least_norm_solution(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& b) {
  return matrix.completeOrthogonalDecomposition().solve(b);
}

SymmetricModes symmetric_modes(const Eigen::MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

SymmetricModes symmetric_modes(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(a, b);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

HermitianModes hermitian_modes(const Eigen::MatrixXcd& a, const Eigen::MatrixXcd& b) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXcd> solver(a, b);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& a) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a, Eigen::EigenvaluesOnly).eigenvalues();
}

Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(a, b, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

Eigen::VectorXcd eigenvalues_of(const Eigen::MatrixXd& matrix) {
  return Eigen::EigenSolver<Eigen::MatrixXd>(matrix, /*computeEigenvectors=*/false).eigenvalues();
}

bool is_positive_definite(const Eigen::MatrixXd& matrix) {
  return Eigen::LLT<Eigen::MatrixXd>(matrix).info() == Eigen::Success;
}

}  // namespace pleuel
