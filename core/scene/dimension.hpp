#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

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

/// The same text, as long as the program lives: quantities hold views of name and unit, also of those
/// that are derived or received. Any thread may call it.
std::string_view kept_text(const std::string& text);

}  // namespace pleuel
