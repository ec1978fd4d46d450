#include "core/base/dense_solvers.hpp"

#include <algorithm>
#include <limits>

#define LAPACK_COMPLEX_CUSTOM
#define lapack_complex_float std::complex<float>
#define lapack_complex_double std::complex<double>
#include <lapacke.h>

#include "core/base/int_size.hpp"

namespace pleuel {

namespace {

constexpr int columns_first = LAPACK_COL_MAJOR;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

template <class Derived>
int row_count(const Eigen::MatrixBase<Derived>& matrix) {
  return static_cast<int>(matrix.rows());
}
template <class Derived>
int column_count(const Eigen::MatrixBase<Derived>& matrix) {
  return static_cast<int>(matrix.cols());
}
/// The distance of two columns in memory: at least one, says LAPACK.
template <class Derived>
int stride(const Eigen::MatrixBase<Derived>& matrix) {
  return std::max(1, row_count(matrix));
}

/// LAPACK leaves matrices as they are where an entry is not a number (info < 0), and says where
/// iterations do not converge (info > 0).
template <class Matrix>
void mark_failed(int info, Matrix& result) {
  if (info != 0) result.setConstant(std::numeric_limits<double>::quiet_NaN());
}

int factorize(Eigen::MatrixXd& a, int* rows) {
  return LAPACKE_dgetrf(columns_first, row_count(a), row_count(a), a.data(), stride(a), rows);
}
int factorize(Eigen::MatrixXcd& a, int* rows) {
  return LAPACKE_zgetrf(columns_first, row_count(a), row_count(a), a.data(), stride(a), rows);
}
int solve_factorized(char operation, const Eigen::MatrixXd& a, const int* rows,
                     Eigen::MatrixXd& x) {
  return LAPACKE_dgetrs(columns_first, operation, row_count(a), column_count(x), a.data(),
                        stride(a), rows, x.data(), stride(x));
}
int solve_factorized(char operation, const Eigen::MatrixXcd& a, const int* rows,
                     Eigen::MatrixXcd& x) {
  return LAPACKE_zgetrs(columns_first, operation, row_count(a), column_count(x), a.data(),
                        stride(a), rows, x.data(), stride(x));
}
int estimate_condition(const Eigen::MatrixXd& a, double norm, double& result) {
  return LAPACKE_dgecon(columns_first, '1', row_count(a), a.data(), stride(a), norm, &result);
}
int estimate_condition(const Eigen::MatrixXcd& a, double norm, double& result) {
  return LAPACKE_zgecon(columns_first, '1', row_count(a), a.data(), stride(a), norm, &result);
}

/// @param job  'V' with vectors, 'N' without
SymmetricModes modes(char job, const Eigen::MatrixXd& a) {
  SymmetricModes result{Eigen::VectorXd(a.rows()), a};
  const int info = LAPACKE_dsyevd(columns_first, job, 'L', row_count(a), result.vectors.data(),
                                  stride(a), result.values.data());
  mark_failed(info, result.values);
  mark_failed(info, result.vectors);
  return result;
}

SymmetricModes modes(char job, const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  SymmetricModes result{Eigen::VectorXd(a.rows()), a};
  Eigen::MatrixXd factor = b;
  const int info = LAPACKE_dsygvd(columns_first, 1, job, 'L', row_count(a), result.vectors.data(),
                                  stride(a), factor.data(), stride(b), result.values.data());
  mark_failed(info, result.values);
  mark_failed(info, result.vectors);
  return result;
}

}  // namespace

PivotedQr::PivotedQr(const Eigen::MatrixXd& matrix)
    : PivotedQr(matrix, epsilon * static_cast<double>(std::min(matrix.rows(), matrix.cols()))) {}

PivotedQr::PivotedQr(const Eigen::MatrixXd& matrix, double threshold)
    : qr_(matrix),
      factors_(std::min(matrix.rows(), matrix.cols())),
      order_(static_cast<std::size_t>(matrix.cols()), 0),
      threshold_(threshold) {
  mark_failed(LAPACKE_dgeqp3(columns_first, row_count(qr_), column_count(qr_), qr_.data(),
                             stride(qr_), order_.data(), factors_.data()),
              qr_);
}

Eigen::Index PivotedQr::rank() const {
  const Eigen::VectorXd sizes = pivots();
  return sizes.size() == 0 ? 0 : (sizes.array() > threshold_ * sizes(0)).count();
}

std::vector<int> PivotedQr::order() const {
  std::vector<int> order = order_;
  for (int& column : order) --column;
  return order;
}

Eigen::VectorXd PivotedQr::pivots() const {
  return qr_.diagonal().cwiseAbs();
}

Eigen::MatrixXd PivotedQr::q() const {
  Eigen::MatrixXd q = Eigen::MatrixXd::Zero(qr_.rows(), qr_.rows());
  q.leftCols(factors_.size()) = qr_.leftCols(factors_.size());
  mark_failed(LAPACKE_dorgqr(columns_first, row_count(q), row_count(q), int_size(factors_),
                             q.data(), stride(q), factors_.data()),
              q);
  return q;
}

Eigen::MatrixXd PivotedQr::normal_space() const {
  return q().rightCols(qr_.rows() - rank());
}

Eigen::VectorXd PivotedQr::solve(const Eigen::VectorXd& b) const {
  const int independent = static_cast<int>(rank());
  Eigen::VectorXd turned = b, z = Eigen::VectorXd::Zero(qr_.cols());
  int info =
      LAPACKE_dormqr(columns_first, 'L', 'T', row_count(qr_), 1, int_size(factors_), qr_.data(),
                     stride(qr_), factors_.data(), turned.data(), stride(turned));
  if (info == 0) {
    info = LAPACKE_dtrtrs(columns_first, 'U', 'N', 'N', independent, 1, qr_.data(), stride(qr_),
                          turned.data(), stride(turned));
  }
  for (int i = 0; i < independent; ++i) z(order_[static_cast<std::size_t>(i)] - 1) = turned(i);
  mark_failed(info, z);
  return z;
}

template <class Scalar>
Lu<Scalar>::Lu(const Matrix& matrix)
    : lu_(matrix), rows_(static_cast<std::size_t>(matrix.rows())), norm_(0.0) {
  if (matrix.size() > 0) norm_ = matrix.cwiseAbs().colwise().sum().maxCoeff();
  const int info = factorize(lu_, rows_.data());
  if (info < 0) mark_failed(info, lu_);  // a pivot of zero, info > 0, makes infinite solutions
}

template <class Scalar>
typename Lu<Scalar>::Matrix Lu<Scalar>::solve(char operation, const Matrix& b) const {
  Matrix x = b;
  mark_failed(solve_factorized(operation, lu_, rows_.data(), x), x);
  return x;
}

template <class Scalar>
typename Lu<Scalar>::Matrix Lu<Scalar>::solve(const Matrix& b) const {
  return solve('N', b);
}

template <class Scalar>
typename Lu<Scalar>::Matrix Lu<Scalar>::solve_transposed(const Matrix& b) const {
  return solve('T', b);
}

template <class Scalar>
double Lu<Scalar>::reciprocal_condition() const {
  double result = 0.0;
  return estimate_condition(lu_, norm_, result) == 0 ? result : 0.0;
}

template class Lu<double>;
template class Lu<std::complex<double>>;

Cholesky::Cholesky(const Eigen::MatrixXd& matrix) : lower_(matrix) {
  const int info =
      LAPACKE_dpotrf(columns_first, 'L', row_count(lower_), lower_.data(), stride(lower_));
  is_positive_definite_ = info == 0;
  for (Eigen::Index j = 1; j < lower_.cols(); ++j) lower_.col(j).head(j).setZero();
}

Eigen::MatrixXd Cholesky::solve(const Eigen::MatrixXd& b) const {
  Eigen::MatrixXd x = b;
  mark_failed(LAPACKE_dpotrs(columns_first, 'L', row_count(lower_), column_count(x), lower_.data(),
                             stride(lower_), x.data(), stride(x)),
              x);
  return x;
}

Eigen::MatrixXd Cholesky::solve_lower(const Eigen::MatrixXd& b) const {
  Eigen::MatrixXd x = b;
  mark_failed(LAPACKE_dtrtrs(columns_first, 'L', 'N', 'N', row_count(lower_), column_count(x),
                             lower_.data(), stride(lower_), x.data(), stride(x)),
              x);
  return x;
}

Eigen::VectorXd least_norm_solution(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& b) {
  Eigen::MatrixXd a = matrix;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(std::max(matrix.rows(), matrix.cols()));
  x.head(b.size()) = b;
  std::vector<int> order(static_cast<std::size_t>(matrix.cols()), 0);
  int rank = 0;
  mark_failed(LAPACKE_dgelsy(columns_first, row_count(a), column_count(a), 1, a.data(), stride(a),
                             x.data(), stride(x), order.data(),
                             epsilon * static_cast<double>(std::min(a.rows(), a.cols())), &rank),
              x);
  return x.head(matrix.cols());
}

SymmetricModes symmetric_modes(const Eigen::MatrixXd& a) {
  return modes('V', a);
}

SymmetricModes symmetric_modes(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return modes('V', a, b);
}

HermitianModes hermitian_modes(const Eigen::MatrixXcd& a, const Eigen::MatrixXcd& b) {
  HermitianModes result{Eigen::VectorXd(a.rows()), a};
  Eigen::MatrixXcd factor = b;
  const int info = LAPACKE_zhegvd(columns_first, 1, 'V', 'L', row_count(a), result.vectors.data(),
                                  stride(a), factor.data(), stride(b), result.values.data());
  mark_failed(info, result.values);
  mark_failed(info, result.vectors);
  return result;
}

Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& a) {
  return modes('N', a).values;
}

Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return modes('N', a, b).values;
}

Eigen::VectorXcd eigenvalues_of(const Eigen::MatrixXd& matrix) {
  Eigen::MatrixXd a = matrix;
  Eigen::VectorXd real(a.rows()), imaginary(a.rows());
  Eigen::VectorXcd values(a.rows());
  const int info = LAPACKE_dgeev(columns_first, 'N', 'N', row_count(a), a.data(), stride(a),
                                 real.data(), imaginary.data(), nullptr, 1, nullptr, 1);
  values.real() = real;
  values.imag() = imaginary;
  mark_failed(info, values);
  return values;
}

}  // namespace pleuel
