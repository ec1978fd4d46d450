#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

/// Physical quantities and the conversion of what a user writes ("120 mm") to SI.
namespace pleuel {

/// A physical quantity: its name with article, for messages, and its SI unit.
struct Quantity {
  std::string_view name;
  std::string_view unit;

  bool operator==(const Quantity& other) const { return unit == other.unit; }
};

namespace quantities {
inline constexpr Quantity pure_number{"a number without unit", "1"};
inline constexpr Quantity length{"a length", "m"};
inline constexpr Quantity mass{"a mass", "kg"};
inline constexpr Quantity inertia{"a moment of inertia", "kg m^2"};
inline constexpr Quantity density{"a density", "kg/m^3"};
inline constexpr Quantity stress{"a stress", "Pa"};
inline constexpr Quantity torque{"a torque", "N m"};
inline constexpr Quantity time{"a time", "s"};
inline constexpr Quantity rate{"a rate", "1/s"};
inline constexpr Quantity frequency{"a frequency", "Hz"};  ///< cycles per second
/// Of a vibration: a number is in rad/s, and "40 Hz" is 40 cycles of 2π rad in a second. An angular
/// speed takes no Hz.
inline constexpr Quantity angular_frequency{"a frequency", "rad/s"};
inline constexpr Quantity angle{"an angle", "rad"};
inline constexpr Quantity angular_speed{"an angular speed", "rad/s"};
inline constexpr Quantity speed{"a speed", "m/s"};
inline constexpr Quantity acceleration{"an acceleration", "m/s^2"};
inline constexpr Quantity force{"a force", "N"};
inline constexpr Quantity power{"a power", "W"};
inline constexpr Quantity energy{"an energy", "J"};
inline constexpr Quantity area{"an area", "m^2"};
inline constexpr Quantity second_moment_of_area{"a second moment of area", "m^4"};
inline constexpr Quantity torsional_shear{"a shear stress per torque", "1/m^3"};
inline constexpr Quantity spring_stiffness{"a spring stiffness", "N/m"};
inline constexpr Quantity damping_constant{"a damping constant", "N s/m"};
inline constexpr Quantity torsional_stiffness{"a torsional stiffness", "N m/rad"};
inline constexpr Quantity torsional_damping{"a torsional damping constant", "N m s/rad"};
inline constexpr Quantity data{"an amount of memory", "B"};  ///< byte
}  // namespace quantities

/// "a length [m]"; "a number without unit".
std::string describe(const Quantity& quantity);

/// The quantity of d/dt, up to the tenth derivative of an angle, a length, a force or a torque.
Quantity per_time(const Quantity& quantity);

/// Why a unit or a text with unit cannot be used, as the end of a sentence.
class UnitError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A number and what follows it: "120 mm" → 120, "mm".
struct WrittenQuantity {
  double value = 0.0;
  std::string unit;
};

/// Splits "120 mm". @throws UnitError if the text does not begin with a finite number.
WrittenQuantity split_quantity(const std::string& text);

struct MeasuredUnit;  // core/scene/dimension.hpp

// The units that can be written: those of the UDUNITS-2 database and "deg", "rev", "Nm", and of
// memory "B" (with prefixes), "KiB", "MiB", "GiB".

/// The SI value of one `unit` of a quantity: unit_scale("mm", length) = 0.001. Never 0.
/// An angle does not come or go silently: "Hz" and "1/min" are no units of angular speed.
/// @throws UnitError if the unit is unknown or belongs to another quantity.
/// @throws std::runtime_error if the database of units is needed (common_units.hpp) and cannot be
///         read.
double unit_scale(const std::string& unit, const Quantity& quantity);

/// The same from the database, which is read once.
double scale_by_database(const std::string& unit, const Quantity& quantity);

/// The SI value of a text such as "120 mm".
/// @throws UnitError also for a missing unit and for a value out of the range of numbers.
double read_quantity(const std::string& text, const Quantity& quantity);

/// Scale and dimension of a unit by itself: "km/h" is 1/3.6 m/s.
/// @throws UnitError if it is unknown or does not count from zero
MeasuredUnit measure_unit(const std::string& unit);

/// The same from the database.
MeasuredUnit measure_by_database(const std::string& unit);

}  // namespace pleuel
