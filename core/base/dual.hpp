#pragma once

#include <complex>

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

/// Forward-mode dual numbers: value and derivatives in `Slots` directions, exact to round-off.
namespace pleuel {

template <int Slots>
using DualOf = Eigen::AutoDiffScalar<Eigen::Matrix<double, Slots, 1>>;

/// One direction: the model is built once for each design variable, with that variable seeded.
using Dual = DualOf<1>;

inline double value_of(double number) {
  return number;
}
inline double value_of(const std::complex<double>& number) {
  return number.real();
}
template <int Slots>
double value_of(const DualOf<Slots>& number) {
  return number.value();
}

/// d(number)/d(direction); zero for a plain number.
inline double derivative_of(double, int = 0) {
  return 0.0;
}
template <int Slots>
double derivative_of(const DualOf<Slots>& number, int direction = 0) {
  return number.derivatives()[direction];
}

/// Entry by entry derivative of a matrix of dual numbers in their one direction.
template <class Derived>
auto derivative_matrix(const Eigen::MatrixBase<Derived>& matrix) {
  return matrix.unaryExpr([](const Dual& number) { return number.derivatives()[0]; }).eval();
}

template <class Derived>
auto value_matrix(const Eigen::MatrixBase<Derived>& matrix) {
  return matrix.unaryExpr([](const auto& number) { return value_of(number); }).eval();
}

}  // namespace pleuel
