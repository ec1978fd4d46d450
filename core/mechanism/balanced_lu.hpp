#pragma once

#include <memory>

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace pleuel {

/// P R A C = L U of a sparse square matrix, with diagonal R and C that bring the largest entry of each
/// row and column near one (Ruiz 2001): rows and columns of different units do not decide the pivots.
/// With partial pivoting by KLU (Davis & Palamadai Natarajan 2010).
class BalancedLu {
 public:
  BalancedLu();
  ~BalancedLu();

  /// @return whether the matrix is regular
  bool factorize(const Eigen::SparseMatrix<double>& matrix);
  /// x of A x = b, for each column.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;
  /// Of det A: 1 or −1.
  int determinant_sign() const;

 private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
  Eigen::VectorXd rows_, columns_;
};

}  // namespace pleuel
