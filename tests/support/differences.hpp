#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <Eigen/Core>

#include "tests/support/dense_algebra.hpp"

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

/// df/ds at s = 0 of the polynomial through f at the degree + 1 Chebyshev points of [from, to], in
/// which 0 lies. For values with noise: it is amplified by no more than 2 degree²/(to − from),
/// which is reached at an end (Markov's inequality), and intervals may be wide, since the
/// truncation of an analytic f falls by a factor with each degree (Trefethen, Approximation Theory
/// and Approximation Practice, SIAM 2013, ch. 8).
template <class Function>
auto derivative_in_interval(Function&& f, double from, double to, int degree) {
  using Value = decltype(f(from));
  const double middle = (from + to) / 2, half = (to - from) / 2;
  // Weights w of the values by Σ w_k T_i(s_k) = T_i'(0): exact for each polynomial of the degree.
  const Eigen::VectorXd points = Eigen::VectorXd::NullaryExpr(
      degree + 1, [&](Eigen::Index k) { return std::cos(std::numbers::pi * double(k) / degree); });
  Eigen::MatrixXd T(degree + 1, degree + 1);
  Eigen::VectorXd T_s(degree + 1);
  const double at = -middle / half;
  T.row(0).setOnes();
  T.row(1) = points;
  T_s(0) = 0.0;
  T_s(1) = 1.0;
  double before = 1.0, here = at;
  for (int i = 2; i <= degree; ++i) {
    T.row(i) = 2.0 * T.row(i - 1).cwiseProduct(points.transpose()) - T.row(i - 2);
    T_s(i) = 2.0 * here + 2.0 * at * T_s(i - 1) - T_s(i - 2);
    const double next = 2.0 * at * here - before;
    before = here;
    here = next;
  }
  const Eigen::VectorXd weights = pleuel::test::least_squares(T, T_s) / half;
  Value derivative = weights(0) * f(middle + half * points(0));
  for (int k = 1; k <= degree; ++k) {
    derivative += weights(k) * f(middle + half * points(k));
  }
  return derivative;
}

/// Largest entry of a − b relative to the largest of b.
template <class A, class B>
double relative_difference(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  const double scale = b.template lpNorm<Eigen::Infinity>();
  const double difference = (a - b).template lpNorm<Eigen::Infinity>();
  return scale > 0.0 ? difference / scale : difference;
}

/// Least-squares slope of log(error) over log(size): the order at which errors fall.
inline double observed_order(const std::vector<double>& sizes, const std::vector<double>& errors) {
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double a = std::log(sizes[i]), b = std::log(errors[i]);
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  const auto n = static_cast<double>(sizes.size());
  return (n * xy - x * y) / (n * xx - x * x);
}
