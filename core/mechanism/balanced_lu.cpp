#include "core/mechanism/balanced_lu.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <klu.h>

namespace pleuel {

namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// A power of two near 1/√x, so that scaling leaves no round-off; 1 for a row of zeros.
double inverse_root(double x) {
  return x > 0.0 ? std::exp2(-std::round(0.5 * std::log2(x))) : 1.0;
}

/// 1 if an even number of exchanges makes it, −1 otherwise.
int parity(const int* permutation, int size) {
  std::vector<bool> is_seen(size, false);
  int sign = 1;
  for (int first = 0; first < size; ++first) {
    for (int i = first; !is_seen[i]; i = permutation[i]) {
      is_seen[i] = true;
      if (permutation[i] != first) sign = -sign;  // a cycle of k has k − 1 exchanges
    }
  }
  return sign;
}

}  // namespace

struct BalancedLu::Factors {
  klu_common common;
  klu_symbolic* symbolic = nullptr;
  klu_numeric* numeric = nullptr;

  Factors() {
    klu_defaults(&common);
    common.scale = -1;  // done here
    common.tol = 1.0;   // the largest entry of its column is the pivot
  }
  Factors(const Factors&) = delete;
  ~Factors() { clear(); }

  void clear() {
    klu_free_numeric(&numeric, &common);
    klu_free_symbolic(&symbolic, &common);
  }

  bool factorize(Matrix& matrix) {
    clear();
    int* starts = matrix.outerIndexPtr();
    int* rows = matrix.innerIndexPtr();
    symbolic = klu_analyze(static_cast<int>(matrix.rows()), starts, rows, &common);
    if (symbolic == nullptr) return false;
    numeric = klu_factor(starts, rows, matrix.valuePtr(), symbolic, &common);
    return numeric != nullptr && common.status == KLU_OK;
  }
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
  return factors_->factorize(balanced);
}

Eigen::MatrixXd BalancedLu::solve(const Eigen::MatrixXd& b) const {
  Eigen::MatrixXd x = rows_.asDiagonal() * b;
  klu_solve(factors_->symbolic, factors_->numeric, static_cast<int>(x.rows()),
            static_cast<int>(x.cols()), x.data(), &factors_->common);
  return columns_.asDiagonal() * x;
}

int BalancedLu::determinant_sign() const {
  const klu_symbolic& symbolic = *factors_->symbolic;
  const auto* diagonal = static_cast<const double*>(factors_->numeric->Udiag);
  int sign = parity(factors_->numeric->Pnum, symbolic.n) * parity(symbolic.Q, symbolic.n);
  for (int i = 0; i < symbolic.n; ++i) {
    if (diagonal[i] < 0.0) sign = -sign;
  }
  return sign;
}

}  // namespace pleuel
