#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "core/base/dual.hpp"

namespace pleuel {

/// A function of time and its derivatives.
template <class Scalar>
struct TimeValue {
  Scalar value, rate, acceleration;
};

/// A prescribed function of time whose parameters may be design variables.
template <class Scalar>
struct TimeLaw {
  enum class Kind {
    polynomial,  ///< parameters cᵢ: Σ cᵢ tⁱ
    ramp,        ///< Ω, T: from rest to the rate Ω within T
    harmonic,    ///< amplitude, frequency ω [rad/s], phase, offset
    spline       ///< values at the knots, then second derivatives there
  };
  Kind kind = Kind::polynomial;
  std::vector<Scalar> parameters;
  std::vector<double> knots;  ///< of a spline [s], ascending

  TimeValue<Scalar> at(double time) const {
    switch (kind) {
      case Kind::polynomial:
        return polynomial_at(time);
      case Kind::ramp:
        return ramp_at(time);
      case Kind::harmonic:
        return harmonic_at(time);
      default:
        return spline_at(time);
    }
  }

  /// The same law with other numbers: function(parameter) for each of them.
  template <class To, class Function>
  TimeLaw<To> transformed(Function&& function) const {
    TimeLaw<To> law;
    law.kind = static_cast<typename TimeLaw<To>::Kind>(kind);
    law.knots = knots;
    for (const Scalar& parameter : parameters) law.parameters.push_back(function(parameter));
    return law;
  }

 private:
  TimeValue<Scalar> polynomial_at(double time) const {
    TimeValue<Scalar> result{Scalar(0), Scalar(0), Scalar(0)};
    for (std::size_t i = parameters.size(); i-- > 0;) {  // Horner's rule with derivatives
      result.acceleration = result.acceleration * time + 2.0 * result.rate;
      result.rate = result.rate * time + result.value;
      result.value = result.value * time + parameters[i];
    }
    return result;
  }

  ///     φ̈ = (Ω/T)(1 − cos 2πt/T),   φ̇ = Ω (t/T − sin(2πt/T)/2π),
  ///     φ = Ω (t²/2T + T (cos 2πt/T − 1)/4π²)          for t < T;      φ̇ = Ω afterwards
  TimeValue<Scalar> ramp_at(double time) const {
    using std::cos;
    using std::sin;
    constexpr double pi = std::numbers::pi;
    const Scalar &speed = parameters[0], &ramp = parameters[1];
    if (time >= value_of(ramp)) return {Scalar(speed * (time - ramp / 2.0)), speed, Scalar(0)};
    const Scalar phase = 2.0 * pi * time / ramp;
    return {
        Scalar(speed * (time * time / (2.0 * ramp) + ramp * (cos(phase) - 1.0) / (4.0 * pi * pi))),
        Scalar(speed * (time / ramp - sin(phase) / (2.0 * pi))),
        Scalar(speed / ramp * (1.0 - cos(phase)))};
  }

  TimeValue<Scalar> harmonic_at(double time) const {
    using std::cos;
    using std::sin;
    const Scalar &amplitude = parameters[0], &frequency = parameters[1];
    const Scalar argument = frequency * time + parameters[2];
    const Scalar oscillation = amplitude * sin(argument);
    return {Scalar(parameters[3] + oscillation), Scalar(amplitude * frequency * cos(argument)),
            Scalar(-frequency * frequency * oscillation)};
  }

  TimeValue<Scalar> spline_at(double time) const {
    const std::size_t last = knots.size() - 1;
    const auto above = std::upper_bound(knots.begin(), knots.end(), time);
    const auto interval = static_cast<std::ptrdiff_t>(above - knots.begin()) - 1;
    const auto i = static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(interval, 0, static_cast<std::ptrdiff_t>(last) - 1));
    const double h = knots[i + 1] - knots[i];
    const double inside = std::clamp(time, knots.front(), knots.back());
    const double b = (inside - knots[i]) / h, a = 1.0 - b;
    const Scalar &y0 = parameters[i], &y1 = parameters[i + 1];
    const Scalar &m0 = parameters[last + 1 + i], &m1 = parameters[last + 2 + i];
    TimeValue<Scalar> result;
    result.value = a * y0 + b * y1 + (h * h / 6.0) * ((a * a * a - a) * m0 + (b * b * b - b) * m1);
    result.rate = (y1 - y0) / h + (h / 6.0) * ((1.0 - 3.0 * a * a) * m0 + (3.0 * b * b - 1.0) * m1);
    result.acceleration = a * m0 + b * m1;
    result.value += (time - inside) * result.rate;
    return result;
  }
};

/// Cubic spline through points with zero second derivative at both ends; beyond them it goes on
/// along the tangent. The second derivatives mᵢ solve
///     hᵢ₋₁ mᵢ₋₁ + 2(hᵢ₋₁ + hᵢ) mᵢ + hᵢ mᵢ₊₁ = 6 ((yᵢ₊₁ − yᵢ)/hᵢ − (yᵢ − yᵢ₋₁)/hᵢ₋₁)
template <class Scalar>
TimeLaw<Scalar> natural_spline(std::vector<double> knots, std::vector<Scalar> values) {
  const std::size_t n = knots.size();
  std::vector<Scalar> moments(n, Scalar(0)), right(n, Scalar(0));
  std::vector<double> pivot(n, 1.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {  // elimination downwards
    const double before = knots[i] - knots[i - 1], after = knots[i + 1] - knots[i];
    const double factor = i > 1 ? before / pivot[i - 1] : 0.0;
    pivot[i] = 2.0 * (before + after) - (i > 1 ? factor * before : 0.0);
    right[i] = 6.0 * ((values[i + 1] - values[i]) / after - (values[i] - values[i - 1]) / before) -
               factor * right[i - 1];
  }
  for (std::size_t i = n - 1; i-- > 1;) {
    const double after = knots[i + 1] - knots[i];
    moments[i] = (right[i] - after * moments[i + 1]) / pivot[i];
  }
  TimeLaw<Scalar> law;
  law.kind = TimeLaw<Scalar>::Kind::spline;
  law.knots = std::move(knots);
  law.parameters = std::move(values);
  law.parameters.insert(law.parameters.end(), moments.begin(), moments.end());
  return law;
}

}  // namespace pleuel
