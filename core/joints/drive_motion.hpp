#pragma once

#include <cmath>
#include <numbers>

#include "core/base/dual.hpp"

namespace pleuel {

/// A prescribed angle and its time derivatives.
template <class Scalar>
struct DriveMotion {
  Scalar angle, rate, acceleration;  ///< [rad], [rad/s], [rad/s²]
};

/// Speed Ω after a smooth start-up over T (from rest; T = 0: Ω from the beginning):
///     φ̈ = (Ω/T)(1 − cos 2πt/T),   φ̇ = Ω (t/T − sin(2πt/T)/2π),
///     φ = Ω (t²/2T + T (cos 2πt/T − 1)/4π²)          for t < T;      φ̇ = Ω afterwards
template <class Scalar>
struct SpeedDrive {
  Scalar speed = Scalar(0);  ///< Ω [rad/s]
  Scalar ramp = Scalar(0);   ///< T [s]

  DriveMotion<Scalar> at(double time) const {
    using std::cos;
    using std::sin;
    constexpr double pi = std::numbers::pi;
    if (time >= value_of(ramp)) {
      return {Scalar(speed * (time - ramp / 2.0)), speed, Scalar(0)};
    }
    const Scalar phase = 2.0 * pi * time / ramp;
    return {
        Scalar(speed * (time * time / (2.0 * ramp) + ramp * (cos(phase) - 1.0) / (4.0 * pi * pi))),
        Scalar(speed * (time / ramp - sin(phase) / (2.0 * pi))),
        Scalar(speed / ramp * (1.0 - cos(phase)))};
  }
};

}  // namespace pleuel
