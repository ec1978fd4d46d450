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
    // Through points; before the first and after the last of them the values there hold.
    step,    ///< values at the knots, each from its knot on
    linear,  ///< values at the knots
    cubic,   ///< values at the knots, then rates there
    quintic  ///< the same; accelerations at the knots are zero
  };
  Kind kind = Kind::polynomial;
  std::vector<Scalar> parameters;
  std::vector<double> knots;  ///< of what goes through points [s], ascending

  TimeValue<Scalar> at(double time) const {
    switch (kind) {
      case Kind::polynomial:
        return polynomial_at(time);
      case Kind::ramp:
        return ramp_at(time);
      case Kind::harmonic:
        return harmonic_at(time);
      case Kind::step:
        return step_at(time);
      default:
        return between_knots_at(time);
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

  /// At a jump the mean of both sides, so that schemes of second order stay so where an instant
  /// lies on it; at t = 0, from where on there is only one, the side that follows.
  TimeValue<Scalar> step_at(double time) const {
    const auto above = std::upper_bound(knots.begin(), knots.end(), time);
    const auto after = static_cast<std::size_t>(std::max<std::ptrdiff_t>(above - knots.begin(), 1));
    const std::size_t now = after - 1;
    Scalar value = parameters[now];
    if (now > 0 && knots[now] == time && time != 0.0) value = 0.5 * (parameters[now - 1] + value);
    return {value, Scalar(0), Scalar(0)};
  }

  TimeValue<Scalar> between_knots_at(double time) const {
    const std::size_t last = knots.size() - 1;
    if (time < knots.front()) return {parameters[0], Scalar(0), Scalar(0)};
    if (time >= knots.back()) return {parameters[last], Scalar(0), Scalar(0)};
    const auto above = std::upper_bound(knots.begin(), knots.end(), time);
    const std::size_t i = static_cast<std::size_t>(above - knots.begin()) - 1;
    const double h = knots[i + 1] - knots[i], s = (time - knots[i]) / h;
    const Scalar &y = parameters[i], rise = parameters[i + 1] - y;
    if (kind == Kind::linear) return {Scalar(y + s * rise), Scalar(rise / h), Scalar(0)};
    const Scalar before = h * parameters[last + 1 + i], after = h * parameters[last + 2 + i];
    // y + before s + c₂ s² + … ; the quintic has no c₂
    if (kind == Kind::cubic) {
      const Scalar c2 = 3.0 * rise - 2.0 * before - after, c3 = before + after - 2.0 * rise;
      return {Scalar(y + s * (before + s * (c2 + s * c3))),
              Scalar((before + s * (2.0 * c2 + 3.0 * s * c3)) / h),
              Scalar((2.0 * c2 + 6.0 * s * c3) / (h * h))};
    }
    const Scalar c3 = 10.0 * rise - 6.0 * before - 4.0 * after,
                 c4 = 8.0 * before + 7.0 * after - 15.0 * rise,
                 c5 = 6.0 * rise - 3.0 * (before + after);
    return {Scalar(y + s * (before + s * s * (c3 + s * (c4 + s * c5)))),
            Scalar((before + s * s * (3.0 * c3 + s * (4.0 * c4 + 5.0 * s * c5))) / h),
            Scalar(s * (6.0 * c3 + s * (12.0 * c4 + 20.0 * s * c5)) / (h * h))};
  }
};

}  // namespace pleuel
