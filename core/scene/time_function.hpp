#pragma once

#include <memory>
#include <variant>
#include <vector>

#include "core/base/time_law.hpp"
#include "core/scene/number.hpp"

/// A prescribed quantity as a function of time: motion of a drive, value of a load. Of what acts
/// along a coordinate it may be a function of that or of its rate, too.
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
  spline,    ///< cubic spline: smoother, but it overshoots where the values turn
  resting    ///< quintics that rest at every point: flanks of a pulse; not of a file
};

/// Whether what lies between the first and the last point goes on before and after them.
enum class Repetition {
  none,     ///< the values at both ends hold
  periodic  ///< the last point is the first of the next period
};

/// Through points. That of a drive that is not repeated starts and ends at rest, but for straight
/// lines (core/base/time_law.hpp). Steps and trapezoids are tables, too.
struct TableFunction {
  std::vector<double> times;   ///< [s], or of what else it is a function; ascending, at least two
  std::vector<Number> values;  ///< as many
  Interpolation interpolation = Interpolation::monotone;
  Repetition repetition = Repetition::none;
  LawArgument argument = LawArgument::time;
};

/// From one value to another; the rate rises and falls as a cubic within `rounding` behind the
/// beginning and before the end, and is constant between.
struct RampFunction {
  Number from, to;
  double begin = 0.0, end = 0.0;  ///< [s]
  double rounding = 0.0;          ///< [s], at most half of the duration
};

/// offset + amplitude · sin(π (t − begin)/duration) while it lasts, else the offset.
struct HalfSineFunction {
  Number amplitude, offset;
  double begin = 0.0, duration = 0.0;  ///< [s]
  double period = 0.0;                 ///< [s]; 0: once
};

/// A formula of t, of design variables, and of the coordinate and the rate that a force element has.
struct ExpressionFunction {
  std::shared_ptr<const Expression> expression;
  std::vector<Number> variables;  ///< each design variable in it as a formula of its own
};

/// value · tanh(ṡ/speed): dry friction without its jump.
struct FrictionLaw {
  Number value;  ///< [N] or [N m]
  Number speed;  ///< [m/s] or [rad/s], positive
};

/// A spring that begins to act where a clearance ends (TimeLaw::clearance_at).
struct ClearanceLaw {
  Number lower = -1e30, upper = 1e30;  ///< ends of the clearance [m] or [rad]
  Number stiffness;                    ///< [N/m] or [N m/rad]
  Number rounding;                     ///< [m] or [rad], positive
};

using TimeFunction = std::variant<ConstantFunction, ConstantSpeedDrive, RampToSpeedDrive,
                                  PolynomialFunction, HarmonicFunction, TableFunction, RampFunction,
                                  HalfSineFunction, ExpressionFunction, FrictionLaw, ClearanceLaw>;

/// Whether it is a function of the coordinate or the rate of a force element.
bool depends_on_state(const TimeFunction& function);

}  // namespace pleuel
