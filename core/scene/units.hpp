#pragma once

#include <memory>
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
inline constexpr Quantity angular_speed{"an angular speed", "rad/s"};
inline constexpr Quantity acceleration{"an acceleration", "m/s^2"};
inline constexpr Quantity stress_time{"a stress times a time", "Pa s"};
inline constexpr Quantity length_time{"a length times a time", "m s"};
inline constexpr Quantity torque_time{"a torque times a time", "N m s"};
}  // namespace quantities

/// "a length [m]"; "a number without unit".
std::string describe(const Quantity& quantity);

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

/// The units that can be written: those of the UDUNITS-2 database and "deg", "rev", "Nm".
class UnitSystem {
 public:
  /// @throws std::runtime_error if the database of units cannot be read.
  UnitSystem();
  ~UnitSystem();
  UnitSystem(UnitSystem&&) noexcept;
  UnitSystem& operator=(UnitSystem&&) noexcept;

  /// The SI value of one `unit` of a quantity: scale("mm", length) = 0.001. Never 0.
  /// An angle does not come or go silently: "Hz" and "1/min" are no units of angular speed.
  /// @throws UnitError if the unit is unknown or belongs to another quantity.
  double scale(const std::string& unit, const Quantity& quantity) const;

  /// The SI value of a text such as "120 mm".
  /// @throws UnitError also for a missing unit and for a value out of the range of numbers.
  double read(const std::string& text, const Quantity& quantity) const;

 private:
  struct Database;
  std::unique_ptr<Database> database_;
};

}  // namespace pleuel
