#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include "core/scene/problem_file.hpp"
#include "core/scene/units.hpp"

namespace pleuel {

/// The powers of the base units that a unit is made of: N = m kg s⁻². Angles count: rad is a base
/// unit, as it never comes or goes silently in a problem file.
struct Dimension {
  static constexpr std::array<const char*, 9> bases = {"m", "kg",  "s",  "rad", "A",
                                                       "K", "mol", "cd", "B"};
  std::array<double, bases.size()> powers{};

  Dimension& multiply(const Dimension& other, double times = 1.0) {
    for (std::size_t i = 0; i < powers.size(); ++i) powers[i] += times * other.powers[i];
    return *this;
  }
  Dimension to_the(double exponent) const { return Dimension{}.multiply(*this, exponent); }
  friend Dimension operator*(Dimension a, const Dimension& b) { return a.multiply(b); }
  friend Dimension operator/(Dimension a, const Dimension& b) { return a.multiply(b, -1.0); }

  /// Powers are sums of few fractions.
  bool operator==(const Dimension& other) const {
    for (std::size_t i = 0; i < powers.size(); ++i) {
      if (std::abs(powers[i] - other.powers[i]) > 1e-9) return false;
    }
    return true;
  }
  bool is_number() const { return *this == Dimension{}; }
  bool is_angle() const { return *this == angle(); }
  static Dimension angle() {
    Dimension angle;
    angle.powers[3] = 1.0;
    return angle;
  }
};

/// What a unit measures.
struct MeasuredUnit {
  double scale = 1.0;  ///< SI value of one of it
  Dimension dimension;
};

/// The SI unit of this dimension in base units: "kg m^2/s^3"; "1" of a number.
std::string base_units(const Dimension& dimension);

/// The quantity that numbers of the file with this dimension have, if it has a name: of m² kg s⁻²
/// "a torque [N m]".
std::optional<Quantity> find_quantity(const Dimension& dimension, const UnitSystem& units);

/// "a length [m]", "a number without unit"; of a quantity without name "a quantity [kg m]".
std::string describe(const Dimension& dimension, const UnitSystem& units);

/// Whether a unit has this dimension. @pre the unit is known
bool has_dimension(const Quantity& quantity, const Dimension& dimension, const UnitSystem& units);

/// What a design variable measures: the quantity of the first number of the scene that is bound to
/// it; else that of the other variables of its linear constraint; else a pure number.
Quantity variable_quantity(const ProblemFile& problem, int variable);

}  // namespace pleuel
