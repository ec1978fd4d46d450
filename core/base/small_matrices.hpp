#pragma once

#include <type_traits>

#include <Eigen/Core>

/// Sums and products of small matrices (at most 6 × 6, of any scalar) are evaluated at once. An
/// expression template costs the compiler some 40 ms for each new type of an expression, and is no
/// faster here: there is nothing to allocate. They are inlined as Eigen's are, always: called as
/// functions they were 5 % of the instructions of a gradient of the slider-crank. In namespace pleuel these operators match better than
/// Eigen's, which take matrices by their base class; all other operands stay with Eigen.
namespace pleuel {

namespace small_matrices {

/// Not the base class, as a generic function takes it: that stays with Eigen.
template <class Matrix, class Derived>
constexpr bool is_matrix(const Eigen::MatrixBase<Derived>*) {
  return std::is_same_v<Matrix, Derived>;
}
template <class Matrix>
constexpr bool is_matrix(const void*) {
  return false;
}

/// A product or an inverse that Eigen has not evaluated yet has no entries.
template <class Matrix>
inline constexpr bool has_entries = true;
template <class Left, class Right, int option>
inline constexpr bool has_entries<Eigen::Product<Left, Right, option>> = false;
template <class Matrix>
inline constexpr bool has_entries<Eigen::Inverse<Matrix>> = false;

constexpr bool is_small(int size) {
  return size > 0 && size <= 6;
}

template <class Matrix>
concept Small = std::is_class_v<Matrix> && has_entries<Matrix> &&
    is_matrix<Matrix>(static_cast<const Matrix*>(nullptr)) &&
    is_small(Matrix::MaxRowsAtCompileTime) && is_small(Matrix::MaxColsAtCompileTime);

template <class Number, class Matrix>
concept ScalarOf = std::is_arithmetic_v<Number> || std::is_same_v<Number, typename Matrix::Scalar>;

template <class Left, class Right>
concept Alike = int(Left::RowsAtCompileTime) == int(Right::RowsAtCompileTime) &&
                int(Left::ColsAtCompileTime) == int(Right::ColsAtCompileTime);

/// A product of a row with a column is Eigen's, which becomes a number.
template <class Left, class Right>
concept Chained = int(Left::ColsAtCompileTime) == int(Right::RowsAtCompileTime) &&
                  (int(Left::RowsAtCompileTime) != 1 || int(Right::ColsAtCompileTime) != 1);

/// As many rows as the left matrix, as many columns as the right one.
template <class Scalar, class Left, class Right = Left>
using Result = Eigen::Matrix<Scalar, Left::RowsAtCompileTime, Right::ColsAtCompileTime,
                             int(Left::RowsAtCompileTime) == 1 && int(Right::ColsAtCompileTime) != 1
                                 ? Eigen::RowMajor
                                 : Eigen::ColMajor,
                             Left::MaxRowsAtCompileTime, Right::MaxColsAtCompileTime>;

template <class Result, class Entry>
EIGEN_ALWAYS_INLINE Result filled(Eigen::Index rows, Eigen::Index columns, const Entry& entry) {
  Result result;
  result.resize(rows, columns);
  for (Eigen::Index j = 0; j < columns; ++j) {
    for (Eigen::Index i = 0; i < rows; ++i) result.coeffRef(i, j) = entry(i, j);
  }
  return result;
}

/// The size as a constant, where it is one: loops over it are unrolled.
template <class Matrix>
constexpr Eigen::Index rows_of(const Matrix& matrix) {
  if constexpr (int(Matrix::RowsAtCompileTime) > 0) return Matrix::RowsAtCompileTime;
  return matrix.rows();
}
template <class Matrix>
constexpr Eigen::Index columns_of(const Matrix& matrix) {
  if constexpr (int(Matrix::ColsAtCompileTime) > 0) return Matrix::ColsAtCompileTime;
  return matrix.cols();
}

/// Entry by entry.
template <class Scalar, class Matrix, class Entry>
EIGEN_ALWAYS_INLINE auto filled_like(const Matrix& matrix, const Entry& entry) {
  return filled<Result<Scalar, Matrix>>(rows_of(matrix), columns_of(matrix), entry);
}

}  // namespace small_matrices

template <small_matrices::Small Left, small_matrices::Small Right>
requires small_matrices::Alike<Left, Right> EIGEN_ALWAYS_INLINE auto operator+(const Left& a,
                                                                               const Right& b) {
  using Scalar = decltype(a.coeff(0, 0) + b.coeff(0, 0));
  return small_matrices::filled_like<Scalar>(
      a, [&](Eigen::Index i, Eigen::Index j) -> Scalar { return a.coeff(i, j) + b.coeff(i, j); });
}

template <small_matrices::Small Left, small_matrices::Small Right>
requires small_matrices::Alike<Left, Right> EIGEN_ALWAYS_INLINE auto operator-(const Left& a,
                                                                               const Right& b) {
  using Scalar = decltype(a.coeff(0, 0) - b.coeff(0, 0));
  return small_matrices::filled_like<Scalar>(
      a, [&](Eigen::Index i, Eigen::Index j) -> Scalar { return a.coeff(i, j) - b.coeff(i, j); });
}

template <small_matrices::Small Matrix>
EIGEN_ALWAYS_INLINE auto operator-(const Matrix& a) {
  using Scalar = typename Matrix::Scalar;
  return small_matrices::filled_like<Scalar>(
      a, [&](Eigen::Index i, Eigen::Index j) -> Scalar { return -a.coeff(i, j); });
}

template <small_matrices::Small Matrix, small_matrices::ScalarOf<Matrix> Number>
EIGEN_ALWAYS_INLINE auto operator*(const Matrix& a, const Number& factor) {
  using Scalar = typename Matrix::Scalar;
  return small_matrices::filled_like<Scalar>(
      a, [&](Eigen::Index i, Eigen::Index j) -> Scalar { return a.coeff(i, j) * factor; });
}

template <small_matrices::Small Matrix, small_matrices::ScalarOf<Matrix> Number>
EIGEN_ALWAYS_INLINE auto operator*(const Number& factor, const Matrix& a) {
  return a * factor;
}

template <small_matrices::Small Matrix, small_matrices::ScalarOf<Matrix> Number>
EIGEN_ALWAYS_INLINE auto operator/(const Matrix& a, const Number& divisor) {
  using Scalar = typename Matrix::Scalar;
  return small_matrices::filled_like<Scalar>(
      a, [&](Eigen::Index i, Eigen::Index j) -> Scalar { return a.coeff(i, j) / divisor; });
}

template <small_matrices::Small Left, small_matrices::Small Right>
requires small_matrices::Chained<Left, Right> EIGEN_ALWAYS_INLINE auto operator*(const Left& a,
                                                                                 const Right& b) {
  using Scalar = decltype(a.coeff(0, 0) * b.coeff(0, 0));
  const Eigen::Index terms = small_matrices::columns_of(a);
  return small_matrices::filled<small_matrices::Result<Scalar, Left, Right>>(
      small_matrices::rows_of(a), small_matrices::columns_of(b),
      [&](Eigen::Index i, Eigen::Index j) -> Scalar {
        if (terms == 0) return Scalar(0);
        Scalar sum = a.coeff(i, 0) * b.coeff(0, j);
        for (Eigen::Index k = 1; k < terms; ++k) sum += a.coeff(i, k) * b.coeff(k, j);
        return sum;
      });
}

}  // namespace pleuel
