#include "core/base/number_text.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace pleuel {

std::string significant(double value, int digits) {
  if (value == 0.0) return "0";
  if (!std::isfinite(value)) return fmt::format("{}", value);
  const auto exponent = static_cast<int>(std::floor(std::log10(std::abs(value))));
  if (exponent < -4 || exponent > 7) return fmt::format("{:.{}e}", value, digits - 1);
  return fmt::format("{:.{}f}", value, std::max(0, digits - 1 - exponent));
}

std::string signed_significant(double value, int digits) {
  if (value == 0.0) return "0";
  return (value < 0.0 ? "−" : "+") + significant(std::abs(value), digits);
}

std::string magnitude(double value) {
  return value == 0.0 ? "0" : fmt::format("{:.1e}", value);
}

std::string percent(double fraction) {
  constexpr double hard_to_read = 10.0;
  if (std::abs(fraction) >= hard_to_read) return significant(fraction, 3) + " times";
  constexpr double shown = 0.0005;  // less is rounded to nothing, and then has no sign
  return fmt::format("{:.1f} %", std::abs(fraction) < shown ? 0.0 : 100.0 * fraction);
}

std::string rough_percent(double share) {
  const double number = 100.0 * share;
  return number < 99.5 ? fmt::format("{:.2g} %", number) : fmt::format("{:.0f} %", number);
}

std::string signed_percent(double fraction) {
  const std::string size = percent(std::abs(fraction));
  if (size == percent(0.0)) return size;
  return (fraction < 0 ? "−" : "+") + size;
}

std::string times_as_large(double ratio) {
  constexpr double most = 100.0;
  if (ratio < 0.0) return "of the other sign";
  if (!(ratio <= most)) return "larger by far";  // infinite, too
  return fmt::format("{:.3g} times as large", ratio);
}

std::string duration(double seconds) {
  if (seconds < 9.95) return fmt::format("{:.2g} s", seconds);
  if (seconds < 99.95) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<long>(std::lround(seconds));
  return fmt::format("{} min {} s", whole / 60, whole % 60);
}

}  // namespace pleuel
