#include "core/base/eager_matrices.hpp"

/// By Eigen's own operators: those of the header would come back here.
namespace pleuel::eager {

template <class Operand>
auto Arithmetic<Operand>::sum(const Operand& a, const Operand& b) -> Result {
  return a.operator+(b);
}
template <class Operand>
auto Arithmetic<Operand>::difference(const Operand& a, const Operand& b) -> Result {
  return a.operator-(b);
}
template <class Operand>
auto Arithmetic<Operand>::scaled(const Operand& a, Scalar factor) -> Result {
  Result result = a;
  result *= factor;
  return result;
}
template <class Operand>
auto Arithmetic<Operand>::quotient(const Operand& a, Scalar divisor) -> Result {
  Result result = a;
  result /= divisor;
  return result;
}
template <class Operand>
auto Arithmetic<Operand>::product(const MatrixRef<Scalar>& a, const Operand& b) -> Result {
  return a.operator*(b);
}
template <class Operand>
auto Arithmetic<Operand>::transposed_product(const MatrixRef<Scalar>& a, const Operand& b)
    -> Result {
  return a.transpose().operator*(b);
}
template <class Operand>
auto Arithmetic<Operand>::scaled_rows(const VectorRef<Scalar>& d, const Operand& a) -> Result {
  Result result = a;
  for (Eigen::Index j = 0; j < a.cols(); ++j) result.col(j).array() *= d.array();
  return result;
}

template struct Arithmetic<VectorRef<double>>;
template struct Arithmetic<MatrixRef<double>>;
template struct Arithmetic<VectorRef<std::complex<double>>>;
template struct Arithmetic<MatrixRef<std::complex<double>>>;

template <class S>
S inner_product(const VectorRef<S>& a, const VectorRef<S>& b) {
  return a.conjugate().dot(b);
}
template double inner_product(const VectorRef<double>&, const VectorRef<double>&);
template std::complex<double> inner_product(const VectorRef<std::complex<double>>&,
                                            const VectorRef<std::complex<double>>&);

template <class S>
MatrixOf<S> outer_product(const VectorRef<S>& a, const VectorRef<S>& b) {
  return a.operator*(b.transpose());
}
template MatrixOf<double> outer_product(const VectorRef<double>&, const VectorRef<double>&);
template MatrixOf<std::complex<double>> outer_product(const VectorRef<std::complex<double>>&,
                                                      const VectorRef<std::complex<double>>&);

template <class S>
MatrixOf<S> scaled_columns(const MatrixRef<S>& a, const VectorRef<S>& d) {
  MatrixOf<S> result = a;
  for (Eigen::Index j = 0; j < a.cols(); ++j) result.col(j) *= d(j);
  return result;
}
template MatrixOf<double> scaled_columns(const MatrixRef<double>&, const VectorRef<double>&);
template MatrixOf<std::complex<double>> scaled_columns(const MatrixRef<std::complex<double>>&,
                                                       const VectorRef<std::complex<double>>&);

template <class Matrix, class Operand>
typename Operand::PlainObject sparse_product(const Matrix& a, const Operand& b) {
  return a.operator*(b);
}
template <class Matrix, class Operand>
typename Operand::PlainObject transposed_sparse_product(const Matrix& a, const Operand& b) {
  return a.transpose().operator*(b);
}

template VectorOf<double> sparse_product(const Columns&, const VectorRef<double>&);
template VectorOf<double> transposed_sparse_product(const Columns&, const VectorRef<double>&);
template MatrixOf<double> sparse_product(const Columns&, const MatrixRef<double>&);
template MatrixOf<double> transposed_sparse_product(const Columns&, const MatrixRef<double>&);
template VectorOf<double> sparse_product(const Rows&, const VectorRef<double>&);
template VectorOf<double> transposed_sparse_product(const Rows&, const VectorRef<double>&);
template MatrixOf<double> sparse_product(const Rows&, const MatrixRef<double>&);
template MatrixOf<double> transposed_sparse_product(const Rows&, const MatrixRef<double>&);

}  // namespace pleuel::eager
