#pragma once

#include <cmath>
#include <type_traits>

#include "core/base/dual.hpp"

/// Functions of time with their first two derivatives, in any scalar type.
namespace pleuel {

/// f, ḟ, f̈. Sums, products and functions follow the chain rule, so that the derivatives are exact.
template <class Scalar>
struct TimeValue {
  Scalar value, rate, acceleration;
};

namespace jet_detail {

/// g(x) from its value and its slope, exact in the first derivatives that the scalar carries.
template <class Scalar>
Scalar lifted(const Scalar& x, double value, double slope) {
  if constexpr (std::is_same_v<Scalar, double>) return value;
  return Scalar(value + slope * (x - value_of(x)));
}

template <class Scalar>
Scalar exponential(const Scalar& x) {
  const double value = std::exp(value_of(x));
  return lifted(x, value, value);
}

template <class Scalar>
Scalar logarithm(const Scalar& x) {
  return lifted(x, std::log(value_of(x)), 1.0 / value_of(x));
}

/// xⁿ; with n = 0 also where x = 0.
template <class Scalar>
Scalar raised(const Scalar& x, const Scalar& n) {
  const double a = value_of(x), b = value_of(n), value = std::pow(a, b);
  const Scalar by_base = lifted(x, value, b == 0.0 ? 0.0 : b * std::pow(a, b - 1.0));
  if constexpr (std::is_same_v<Scalar, double>) return by_base;
  const bool has_logarithm = a > 0.0;  // elsewhere exponents that change have no value
  return has_logarithm ? Scalar(by_base + value * std::log(a) * (n - b)) : by_base;
}

/// g(f) from g, g', g'' at f:  g,  g' ḟ,  g' f̈ + g'' ḟ²
template <class Scalar>
TimeValue<Scalar> composed(const TimeValue<Scalar>& f, const Scalar& g, const Scalar& slope,
                           const Scalar& curvature) {
  return {g, Scalar(slope * f.rate), Scalar(slope * f.acceleration + curvature * f.rate * f.rate)};
}

}  // namespace jet_detail

template <class Scalar>
TimeValue<Scalar> operator+(const TimeValue<Scalar>& f, const TimeValue<Scalar>& g) {
  return {Scalar(f.value + g.value), Scalar(f.rate + g.rate),
          Scalar(f.acceleration + g.acceleration)};
}
template <class Scalar>
TimeValue<Scalar> operator-(const TimeValue<Scalar>& f) {
  return {Scalar(-f.value), Scalar(-f.rate), Scalar(-f.acceleration)};
}
template <class Scalar>
TimeValue<Scalar> operator-(const TimeValue<Scalar>& f, const TimeValue<Scalar>& g) {
  return f + (-g);
}
template <class Scalar>
TimeValue<Scalar> operator*(const TimeValue<Scalar>& f, const TimeValue<Scalar>& g) {
  return {Scalar(f.value * g.value), Scalar(f.rate * g.value + f.value * g.rate),
          Scalar(f.acceleration * g.value + 2.0 * f.rate * g.rate + f.value * g.acceleration)};
}
template <class Scalar>
TimeValue<Scalar> reciprocal(const TimeValue<Scalar>& f) {
  const Scalar g = 1.0 / f.value, slope = -g * g;
  return jet_detail::composed<Scalar>(f, g, slope, Scalar(-2.0 * slope * g));
}
template <class Scalar>
TimeValue<Scalar> operator/(const TimeValue<Scalar>& f, const TimeValue<Scalar>& g) {
  return f * reciprocal(g);
}

template <class Scalar>
TimeValue<Scalar> sqrt(const TimeValue<Scalar>& f) {
  using std::sqrt;
  const Scalar g = sqrt(f.value), slope = 0.5 / g;
  return jet_detail::composed<Scalar>(f, g, slope, Scalar(-0.5 * slope / f.value));
}
template <class Scalar>
TimeValue<Scalar> exp(const TimeValue<Scalar>& f) {
  const Scalar g = jet_detail::exponential(f.value);
  return jet_detail::composed<Scalar>(f, g, g, g);
}
template <class Scalar>
TimeValue<Scalar> log(const TimeValue<Scalar>& f) {
  const Scalar slope = 1.0 / f.value;
  return jet_detail::composed<Scalar>(f, jet_detail::logarithm(f.value), slope,
                                      Scalar(-slope * slope));
}
template <class Scalar>
TimeValue<Scalar> tanh(const TimeValue<Scalar>& f) {
  using std::tanh;
  const Scalar g = tanh(f.value), slope = 1.0 - g * g;
  return jet_detail::composed<Scalar>(f, g, slope, Scalar(-2.0 * g * slope));
}
template <class Scalar>
TimeValue<Scalar> sin(const TimeValue<Scalar>& f) {
  using std::cos;
  using std::sin;
  const Scalar g = sin(f.value);
  return jet_detail::composed<Scalar>(f, g, Scalar(cos(f.value)), Scalar(-g));
}
template <class Scalar>
TimeValue<Scalar> cos(const TimeValue<Scalar>& f) {
  using std::cos;
  using std::sin;
  const Scalar g = cos(f.value);
  return jet_detail::composed<Scalar>(f, g, Scalar(-sin(f.value)), Scalar(-g));
}

/// The angle of the point (x, y):  θ̇ = (x ẏ − y ẋ)/r²,  θ̈ = (x ÿ − y ẍ)/r² − 2 θ̇ (x ẋ + y ẏ)/r²
template <class Scalar>
TimeValue<Scalar> atan2(const TimeValue<Scalar>& y, const TimeValue<Scalar>& x) {
  using std::atan2;
  const Scalar squared = x.value * x.value + y.value * y.value;
  const Scalar rate = (x.value * y.rate - y.value * x.rate) / squared;
  const Scalar growth = 2.0 * (x.value * x.rate + y.value * y.rate) / squared;
  return {Scalar(atan2(y.value, x.value)), rate,
          Scalar((x.value * y.acceleration - y.value * x.acceleration) / squared - rate * growth)};
}

/// fⁿ with an exponent that does not change with time.
template <class Scalar>
TimeValue<Scalar> raised(const TimeValue<Scalar>& f, const Scalar& n) {
  const Scalar less = n - 1.0, least = n - 2.0, factor = n * less;
  const bool is_zero = value_of(f.value) == 0.0;  // 0 times an infinite power is 0
  const auto times_power = [&](const Scalar& by, const Scalar& exponent) {
    return is_zero && value_of(by) == 0.0 ? Scalar(0)
                                          : Scalar(by * jet_detail::raised(f.value, exponent));
  };
  const Scalar slope = times_power(n, less), curvature = times_power(factor, least);
  return jet_detail::composed<Scalar>(f, jet_detail::raised(f.value, n), slope, curvature);
}

}  // namespace pleuel
