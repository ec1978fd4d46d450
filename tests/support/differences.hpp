#pragma once

#include <algorithm>

#include <Eigen/Core>

/// d f/ds at s = 0 by central differences with one Richardson step: error O(h⁴), and exact up to
/// round-off for polynomials of degree four.
template <class Function>
auto derivative_at_zero(Function&& f, double h) {
  using Value = decltype(f(h));
  const Value wide = (f(h) - f(-h)) / (2 * h);
  const Value narrow = (f(h / 2) - f(-h / 2)) / h;
  return Value((4.0 * narrow - wide) / 3.0);
}

/// d²f/ds² at s = 0, likewise.
template <class Function>
auto second_derivative_at_zero(Function&& f, double h) {
  using Value = decltype(f(h));
  const Value middle = f(0.0);
  const Value wide = (f(h) - 2.0 * middle + f(-h)) / (h * h);
  const Value narrow = (f(h / 2) - 2.0 * middle + f(-h / 2)) / (h * h / 4);
  return Value((4.0 * narrow - wide) / 3.0);
}

/// Largest entry of a − b relative to the largest of b.
template <class A, class B>
double relative_difference(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  const double scale = b.template lpNorm<Eigen::Infinity>();
  const double difference = (a - b).template lpNorm<Eigen::Infinity>();
  return scale > 0.0 ? difference / scale : difference;
}
