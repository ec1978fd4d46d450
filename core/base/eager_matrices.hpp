#pragma once

#include <complex>
#include <type_traits>

#include <Eigen/Core>
#include <Eigen/SparseCore>

/// Sums and products of vectors and matrices of any size are evaluated at once, by functions that
/// are compiled once: for sources that do not compute in every step. Each new type of an expression
/// costs the compiler some 40 ms, and what an expression saves, a temporary vector, does not count
/// there. In namespace pleuel these operators match better than Eigen's, which take matrices by
/// their base class.
///
/// Sources include this, headers do not: what computes in every step must not allocate.
namespace pleuel {

namespace eager {

template <class Scalar>
using MatrixOf = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
template <class Scalar>
using VectorOf = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
template <class Scalar>
using MatrixRef = Eigen::Ref<const MatrixOf<Scalar>, 0, Eigen::OuterStride<>>;
template <class Scalar>
using VectorRef = Eigen::Ref<const VectorOf<Scalar>>;
using Columns = Eigen::SparseMatrix<double>;
using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// With one operand as a function takes it: a VectorRef or a MatrixRef of double or
/// std::complex<double>.
template <class Operand>
struct Arithmetic {
  using Scalar = typename Operand::Scalar;
  using Result = typename Operand::PlainObject;

  static Result sum(const Operand& a, const Operand& b);
  static Result difference(const Operand& a, const Operand& b);
  static Result scaled(const Operand& a, Scalar factor);
  static Result quotient(const Operand& a, Scalar divisor);
  static Result product(const MatrixRef<Scalar>& a, const Operand& b);
  /// aᵀ b.
  static Result transposed_product(const MatrixRef<Scalar>& a, const Operand& b);
  /// diag(d) a.
  static Result scaled_rows(const VectorRef<Scalar>& d, const Operand& a);
};

/// For double and std::complex<double>: aᵀ b, a bᵀ and a diag(d).
template <class S>
S inner_product(const VectorRef<S>& a, const VectorRef<S>& b);
template <class S>
MatrixOf<S> outer_product(const VectorRef<S>& a, const VectorRef<S>& b);
template <class S>
MatrixOf<S> scaled_columns(const MatrixRef<S>& a, const VectorRef<S>& d);

/// A sparse matrix, Columns or Rows, or its transpose times a VectorRef or a MatrixRef of double.
template <class Matrix, class Operand>
typename Operand::PlainObject sparse_product(const Matrix& a, const Operand& b);
template <class Matrix, class Operand>
typename Operand::PlainObject transposed_sparse_product(const Matrix& a, const Operand& b);

template <class Scalar>
inline constexpr bool is_complex = std::is_same_v<Scalar, std::complex<double>>;
template <class Scalar>
inline constexpr bool is_number = is_complex<Scalar> || std::is_same_v<Scalar, double>;

/// A column or a rectangle of numbers whose size the compiler does not know. Not its base class, as a
/// generic function takes it: that stays with Eigen.
template <class Operand, class Derived>
constexpr bool is_dense(const Eigen::MatrixBase<Derived>*) {
  return std::is_same_v<Operand, Derived> && is_number<typename Derived::Scalar> &&
         int(Derived::MaxRowsAtCompileTime) == Eigen::Dynamic &&
         (int(Derived::MaxColsAtCompileTime) == Eigen::Dynamic ||
          int(Derived::ColsAtCompileTime) == 1);
}
template <class Operand>
constexpr bool is_dense(const void*) {
  return false;
}

template <class Operand>
concept Dense = std::is_class_v<Operand> && is_dense<Operand>(static_cast<const Operand*>(nullptr));
template <class Operand>
concept Vector = Dense<Operand> && int(Operand::ColsAtCompileTime) == 1;
template <class Operand>
concept Matrix = Dense<Operand> && int(Operand::ColsAtCompileTime) == Eigen::Dynamic;
template <class Operand>
concept Sparse = std::is_same_v<Operand, Columns> || std::is_same_v<Operand, Rows>;
template <class Operand>
concept Number = std::is_arithmetic_v<Operand> || is_complex<Operand>;

template <class Operand>
inline constexpr bool is_transposed_vector = false;
template <class Operand>
inline constexpr bool is_transposed_vector<Eigen::Transpose<Operand>> =
    Vector<std::remove_const_t<Operand>>;
template <class Operand>
inline constexpr bool is_transposed_matrix = false;
template <class Operand>
inline constexpr bool is_transposed_matrix<Eigen::Transpose<Operand>> =
    Matrix<std::remove_const_t<Operand>>;
template <class Operand>
inline constexpr bool is_transposed_sparse = false;
template <class Operand>
inline constexpr bool is_transposed_sparse<Eigen::Transpose<Operand>> =
    Sparse<std::remove_const_t<Operand>>;
template <class Operand>
concept TransposedVector = is_transposed_vector<Operand>;
template <class Operand>
concept TransposedSparse = is_transposed_sparse<Operand>;

/// double, or complex where one of both is.
template <class A, class B>
using Common = std::conditional_t<is_complex<A> || is_complex<B>, std::complex<double>, double>;
template <class A, class B>
using CommonScalar = Common<typename A::Scalar, typename B::Scalar>;

/// What a function takes in place of an operand.
template <class Scalar, class Operand>
using Taken = std::conditional_t<Vector<Operand>, VectorRef<Scalar>, MatrixRef<Scalar>>;

/// A copy if the operand does not stand in memory column by column.
template <class Scalar, Dense Operand>
Taken<Scalar, Operand> taken(const Operand& a) {
  if constexpr (std::is_same_v<Scalar, typename Operand::Scalar>) {
    return a;
  } else {
    return a.template cast<Scalar>();
  }
}

}  // namespace eager

template <eager::Dense A, eager::Dense B>
requires(eager::Vector<A> == eager::Vector<B>) auto operator+(const A& a, const B& b) {
  using S = eager::CommonScalar<A, B>;
  return eager::Arithmetic<eager::Taken<S, A>>::sum(eager::taken<S>(a), eager::taken<S>(b));
}
template <eager::Dense A, eager::Dense B>
requires(eager::Vector<A> == eager::Vector<B>) auto operator-(const A& a, const B& b) {
  using S = eager::CommonScalar<A, B>;
  return eager::Arithmetic<eager::Taken<S, A>>::difference(eager::taken<S>(a), eager::taken<S>(b));
}
template <eager::Dense A>
auto operator-(const A& a) {
  using S = typename A::Scalar;
  return eager::Arithmetic<eager::Taken<S, A>>::scaled(eager::taken<S>(a), S(-1.0));
}
template <eager::Dense A, eager::Number Factor>
auto operator*(const A& a, const Factor& factor) {
  using S = eager::Common<typename A::Scalar, Factor>;
  return eager::Arithmetic<eager::Taken<S, A>>::scaled(eager::taken<S>(a), S(factor));
}
template <eager::Dense A, eager::Number Factor>
auto operator*(const Factor& factor, const A& a) {
  return a * factor;
}
template <eager::Dense A, eager::Number Divisor>
auto operator/(const A& a, const Divisor& divisor) {
  using S = eager::Common<typename A::Scalar, Divisor>;
  return eager::Arithmetic<eager::Taken<S, A>>::quotient(eager::taken<S>(a), S(divisor));
}
template <eager::Matrix A, eager::Dense B>
auto operator*(const A& a, const B& b) {
  using S = eager::CommonScalar<A, B>;
  using Arithmetic = eager::Arithmetic<eager::Taken<S, B>>;
  if constexpr (eager::is_transposed_matrix<A>) {
    return Arithmetic::transposed_product(eager::taken<S>(a.nestedExpression()),
                                          eager::taken<S>(b));
  } else {
    return Arithmetic::product(eager::taken<S>(a), eager::taken<S>(b));
  }
}
template <eager::Sparse A, eager::Dense B>
requires(!eager::is_complex<typename B::Scalar>) auto operator*(const A& a, const B& b) {
  return eager::sparse_product(a, eager::taken<double>(b));
}
template <eager::TransposedSparse A, eager::Dense B>
requires(!eager::is_complex<typename B::Scalar>) auto operator*(const A& a, const B& b) {
  return eager::transposed_sparse_product(a.nestedExpression(), eager::taken<double>(b));
}
template <eager::TransposedVector A, eager::Vector B>
auto operator*(const A& a, const B& b) {
  using S = eager::CommonScalar<A, B>;
  return eager::inner_product<S>(eager::taken<S>(a.nestedExpression()), eager::taken<S>(b));
}
template <eager::TransposedVector A, eager::Matrix B>
auto operator*(const A& a, const B& b) {
  using S = eager::CommonScalar<A, B>;
  return Eigen::Matrix<S, 1, Eigen::Dynamic>((b.transpose() * a.nestedExpression()).transpose());
}
template <eager::Vector A, eager::TransposedVector B>
auto operator*(const A& a, const B& b) {
  using S = eager::CommonScalar<A, B>;
  return eager::outer_product<S>(eager::taken<S>(a), eager::taken<S>(b.nestedExpression()));
}
template <eager::Vector D, eager::Dense A>
auto operator*(const Eigen::DiagonalWrapper<const D>& d, const A& a) {
  using S = eager::CommonScalar<D, A>;
  using Arithmetic = eager::Arithmetic<eager::Taken<S, A>>;
  return Arithmetic::scaled_rows(eager::taken<S>(d.diagonal()), eager::taken<S>(a));
}
template <eager::Matrix A, eager::Vector D>
auto operator*(const A& a, const Eigen::DiagonalWrapper<const D>& d) {
  using S = eager::CommonScalar<A, D>;
  return eager::scaled_columns<S>(eager::taken<S>(a), eager::taken<S>(d.diagonal()));
}

}  // namespace pleuel
