#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace pleuel {

/// Random numbers that are the same with every standard library, to rounding of log and cos: the
/// engine is prescribed by the standard, its distributions are not.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : engine_(seed) {}

  /// In [0, 1): the upper 53 bits.
  double uniform() { return std::ldexp(static_cast<double>(engine_() >> 11), -53); }

  /// Mean 0, deviation 1 (Box & Muller 1958).
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace pleuel
