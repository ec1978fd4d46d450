#pragma once

#include <string>

#include <fmt/format.h>

namespace pleuel {

/// A share in percent, without the sign: two digits, and no exponent.
inline std::string percent(double share) {
  const double number = 100.0 * share;
  return number < 99.5 ? fmt::format("{:.2g}", number) : fmt::format("{:.0f}", number);
}

}  // namespace pleuel
