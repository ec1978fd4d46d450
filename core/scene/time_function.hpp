#pragma once

#include <variant>
#include <vector>

#include "core/scene/number.hpp"

/// A prescribed quantity as a function of time: motion of a drive, value of a load.
namespace pleuel {

struct ConstantFunction {
  Number value;
};

/// rate · t: a drive of constant speed.
struct ConstantSpeedDrive {
  Number speed;  ///< [rad/s] or [m/s]
};

/// Starts from rest: φ̈ = (Ω/T)(1 − cos 2πt/T) for t < T, then φ̇ = Ω.
struct RampToSpeedDrive {
  Number speed;  ///< Ω [rad/s] or [m/s]
  Number ramp;   ///< T [s]
};

/// Σ coefficientᵢ tⁱ
struct PolynomialFunction {
  std::vector<Number> coefficients;  ///< [unit/sⁱ], at least one
};

/// offset + amplitude · sin(frequency · t + phase)
struct HarmonicFunction {
  Number amplitude, frequency;  ///< frequency [rad/s]
  Number phase, offset;         ///< phase [rad]
};

/// Cubic spline through points, natural at both ends (zero second derivative); beyond them it goes
/// on along the tangent.
struct TableFunction {
  std::vector<double> times;   ///< [s], ascending, at least two
  std::vector<Number> values;  ///< as many
};

using TimeFunction = std::variant<ConstantFunction, ConstantSpeedDrive, RampToSpeedDrive,
                                  PolynomialFunction, HarmonicFunction, TableFunction>;

}  // namespace pleuel
