#include "core/base/balanced_lu.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/SparseLU>

namespace pleuel {

namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// A power of two near 1/√x, so that scaling leaves no round-off; 1 for a row of zeros.
double inverse_root(double x) {
  return x > 0.0 ? std::exp2(-std::round(0.5 * std::log2(x))) : 1.0;
}

}  // namespace

struct BalancedLu::Factors {
  Eigen::SparseLU<Matrix> lu;
  bool is_analyzed = false;
};

BalancedLu::BalancedLu() : factors_(std::make_unique<Factors>()) {}
BalancedLu::~BalancedLu() = default;

bool BalancedLu::factorize(const Matrix& matrix) {
  constexpr int passes = 4;  // each halves the exponents that are left
  Matrix balanced = matrix;
  rows_.setOnes(matrix.rows());
  columns_.setOnes(matrix.cols());
  for (int pass = 0; pass < passes; ++pass) {
    Eigen::VectorXd of_rows = Eigen::VectorXd::Zero(matrix.rows()),
                    of_columns = Eigen::VectorXd::Zero(matrix.cols());
    for (int column = 0; column < balanced.outerSize(); ++column) {
      for (Matrix::InnerIterator entry(balanced, column); entry; ++entry) {
        const double size = std::abs(entry.value());
        of_rows(entry.row()) = std::max(of_rows(entry.row()), size);
        of_columns(column) = std::max(of_columns(column), size);
      }
    }
    const Eigen::VectorXd row = of_rows.unaryExpr(&inverse_root),
                          column = of_columns.unaryExpr(&inverse_root);
    rows_.array() *= row.array();
    columns_.array() *= column.array();
    balanced = row.asDiagonal() * balanced * column.asDiagonal();
  }
  if (!factors_->is_analyzed) factors_->lu.analyzePattern(balanced);
  factors_->is_analyzed = true;
  factors_->lu.factorize(balanced);
  return factors_->lu.info() == Eigen::Success;
}

Eigen::MatrixXd BalancedLu::solve(const Eigen::MatrixXd& b) const {
  const Eigen::MatrixXd scaled = rows_.asDiagonal() * b;
  const Eigen::MatrixXd solution = factors_->lu.solve(scaled);
  return columns_.asDiagonal() * solution;
}

}  // namespace pleuel
