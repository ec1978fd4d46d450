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

/// How a table goes from point to point.
enum class Interpolation {
  step,      ///< each value holds until the next time; not for drives
  linear,    ///< straight lines
  monotone,  ///< smooth, and never beyond the values on either side
  spline     ///< cubic spline: smoother, but it overshoots where the values turn
};

/// Through points; before the first and after the last of them the values there hold. That of a
/// drive starts and ends at rest, but for straight lines (core/base/table_law.hpp).
struct TableFunction {
  std::vector<double> times;   ///< [s], ascending, at least two
  std::vector<Number> values;  ///< as many
  Interpolation interpolation = Interpolation::monotone;
};

using TimeFunction = std::variant<ConstantFunction, ConstantSpeedDrive, RampToSpeedDrive,
                                  PolynomialFunction, HarmonicFunction, TableFunction>;

}  // namespace pleuel
