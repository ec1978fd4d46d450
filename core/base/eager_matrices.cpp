#include "core/base/eager_matrices.hpp"

/// By Eigen's own operators: those of the header would come back here.
namespace pleuel::eager {

template <class S>
VectorOf<S> sum(const VectorRef<S>& a, const VectorRef<S>& b) {
  return a.operator+(b);
}
template <class S>
VectorOf<S> difference(const VectorRef<S>& a, const VectorRef<S>& b) {
  return a.operator-(b);
}
template <class S>
VectorOf<S> scaled(const VectorRef<S>& a, S factor) {
  VectorOf<S> result = a;
  result *= factor;
  return result;
}
template <class S>
VectorOf<S> quotient(const VectorRef<S>& a, S divisor) {
  VectorOf<S> result = a;
  result /= divisor;
  return result;
}
template <class S>
VectorOf<S> product(const MatrixRef<S>& a, const VectorRef<S>& b) {
  return a.operator*(b);
}
template <class S>
VectorOf<S> transposed_product(const MatrixRef<S>& a, const VectorRef<S>& b) {
  return a.transpose().operator*(b);
}
template <class S>
VectorOf<S> scaled_rows(const VectorRef<S>& d, const VectorRef<S>& a) {
  VectorOf<S> result = a;
  for (Eigen::Index j = 0; j < a.cols(); ++j) result.col(j).array() *= d.array();
  return result;
}

template <class S>
MatrixOf<S> sum(const MatrixRef<S>& a, const MatrixRef<S>& b) {
  return a.operator+(b);
}
template <class S>
MatrixOf<S> difference(const MatrixRef<S>& a, const MatrixRef<S>& b) {
  return a.operator-(b);
}
template <class S>
MatrixOf<S> scaled(const MatrixRef<S>& a, S factor) {
  MatrixOf<S> result = a;
  result *= factor;
  return result;
}
template <class S>
MatrixOf<S> quotient(const MatrixRef<S>& a, S divisor) {
  MatrixOf<S> result = a;
  result /= divisor;
  return result;
}
template <class S>
MatrixOf<S> product(const MatrixRef<S>& a, const MatrixRef<S>& b) {
  return a.operator*(b);
}
template <class S>
MatrixOf<S> transposed_product(const MatrixRef<S>& a, const MatrixRef<S>& b) {
  return a.transpose().operator*(b);
}
template <class S>
MatrixOf<S> scaled_rows(const VectorRef<S>& d, const MatrixRef<S>& a) {
  MatrixOf<S> result = a;
  for (Eigen::Index j = 0; j < a.cols(); ++j) result.col(j).array() *= d.array();
  return result;
}

template <class S>
S transposed_product(const VectorRef<S>& a, const VectorRef<S>& b) {
  return a.conjugate().dot(b);
}

template <class S>
MatrixOf<S> outer_product(const VectorRef<S>& a, const VectorRef<S>& b) {
  return a.operator*(b.transpose());
}

template <class S>
MatrixOf<S> scaled_columns(const MatrixRef<S>& a, const VectorRef<S>& d) {
  MatrixOf<S> result = a;
  for (Eigen::Index j = 0; j < a.cols(); ++j) result.col(j) *= d(j);
  return result;
}

template VectorOf<double> sum(const VectorRef<double>&, const VectorRef<double>&);
template VectorOf<double> difference(const VectorRef<double>&, const VectorRef<double>&);
template VectorOf<double> scaled(const VectorRef<double>&, double);
template VectorOf<double> quotient(const VectorRef<double>&, double);
template VectorOf<double> product(const MatrixRef<double>&, const VectorRef<double>&);
template VectorOf<double> transposed_product(const MatrixRef<double>&, const VectorRef<double>&);
template VectorOf<double> scaled_rows(const VectorRef<double>&, const VectorRef<double>&);
template MatrixOf<double> sum(const MatrixRef<double>&, const MatrixRef<double>&);
template MatrixOf<double> difference(const MatrixRef<double>&, const MatrixRef<double>&);
template MatrixOf<double> scaled(const MatrixRef<double>&, double);
template MatrixOf<double> quotient(const MatrixRef<double>&, double);
template MatrixOf<double> product(const MatrixRef<double>&, const MatrixRef<double>&);
template MatrixOf<double> transposed_product(const MatrixRef<double>&, const MatrixRef<double>&);
template MatrixOf<double> scaled_rows(const VectorRef<double>&, const MatrixRef<double>&);
template double transposed_product(const VectorRef<double>&, const VectorRef<double>&);
template MatrixOf<double> outer_product(const VectorRef<double>&, const VectorRef<double>&);
template MatrixOf<double> scaled_columns(const MatrixRef<double>&, const VectorRef<double>&);
template VectorOf<std::complex<double>> sum(const VectorRef<std::complex<double>>&,
                                            const VectorRef<std::complex<double>>&);
template VectorOf<std::complex<double>> difference(const VectorRef<std::complex<double>>&,
                                                   const VectorRef<std::complex<double>>&);
template VectorOf<std::complex<double>> scaled(const VectorRef<std::complex<double>>&,
                                               std::complex<double>);
template VectorOf<std::complex<double>> quotient(const VectorRef<std::complex<double>>&,
                                                 std::complex<double>);
template VectorOf<std::complex<double>> product(const MatrixRef<std::complex<double>>&,
                                                const VectorRef<std::complex<double>>&);
template VectorOf<std::complex<double>> transposed_product(const MatrixRef<std::complex<double>>&,
                                                           const VectorRef<std::complex<double>>&);
template VectorOf<std::complex<double>> scaled_rows(const VectorRef<std::complex<double>>&,
                                                    const VectorRef<std::complex<double>>&);
template MatrixOf<std::complex<double>> sum(const MatrixRef<std::complex<double>>&,
                                            const MatrixRef<std::complex<double>>&);
template MatrixOf<std::complex<double>> difference(const MatrixRef<std::complex<double>>&,
                                                   const MatrixRef<std::complex<double>>&);
template MatrixOf<std::complex<double>> scaled(const MatrixRef<std::complex<double>>&,
                                               std::complex<double>);
template MatrixOf<std::complex<double>> quotient(const MatrixRef<std::complex<double>>&,
                                                 std::complex<double>);
template MatrixOf<std::complex<double>> product(const MatrixRef<std::complex<double>>&,
                                                const MatrixRef<std::complex<double>>&);
template MatrixOf<std::complex<double>> transposed_product(const MatrixRef<std::complex<double>>&,
                                                           const MatrixRef<std::complex<double>>&);
template MatrixOf<std::complex<double>> scaled_rows(const VectorRef<std::complex<double>>&,
                                                    const MatrixRef<std::complex<double>>&);
template std::complex<double> transposed_product(const VectorRef<std::complex<double>>&,
                                                 const VectorRef<std::complex<double>>&);
template MatrixOf<std::complex<double>> outer_product(const VectorRef<std::complex<double>>&,
                                                      const VectorRef<std::complex<double>>&);
template MatrixOf<std::complex<double>> scaled_columns(const MatrixRef<std::complex<double>>&,
                                                       const VectorRef<std::complex<double>>&);

VectorOf<double> product(const Columns& a, const VectorRef<double>& b) {
  return a.operator*(b);
}
VectorOf<double> transposed_product(const Columns& a, const VectorRef<double>& b) {
  return a.transpose().operator*(b);
}
VectorOf<double> product(const Rows& a, const VectorRef<double>& b) {
  return a.operator*(b);
}
VectorOf<double> transposed_product(const Rows& a, const VectorRef<double>& b) {
  return a.transpose().operator*(b);
}
MatrixOf<double> product(const Columns& a, const MatrixRef<double>& b) {
  return a.operator*(b);
}
MatrixOf<double> transposed_product(const Columns& a, const MatrixRef<double>& b) {
  return a.transpose().operator*(b);
}
MatrixOf<double> product(const Rows& a, const MatrixRef<double>& b) {
  return a.operator*(b);
}
MatrixOf<double> transposed_product(const Rows& a, const MatrixRef<double>& b) {
  return a.transpose().operator*(b);
}

}  // namespace pleuel::eager
