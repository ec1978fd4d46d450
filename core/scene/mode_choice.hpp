#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "core/base/error.hpp"

namespace pleuel {

/// What of a mode is asked for. Its motion is Re(e^{st} φ).
enum class ModeNumber {
  frequency,      ///< |Im s| without damping [rad/s]
  damping_ratio,  ///< −Re s/|s|
  growth_rate     ///< Re s [1/s]
};

/// Which mode is meant, and what of it.
struct ModeChoice {
  /// In place of a number: the mode that is damped least, or that grows fastest.
  static constexpr int worst = -1;

  int number = 0;  ///< from 0 for the lowest of those that count
  /// A unit vector: only modes along it count, with more than half of their kinetic energy. Its axes
  /// are those of the body whose frequency it is, and global ones of a mechanism.
  std::optional<std::array<double, 3>> axis = {};
  ModeNumber of = ModeNumber::frequency;

  bool counts_damping() const { return of != ModeNumber::frequency; }

  auto operator<=>(const ModeChoice&) const = default;
};

/// `along y`, or `along (0.6, 0.8, 0)`.
inline std::string describe_axis(const std::array<double, 3>& axis) {
  constexpr const char* names[] = {"along x", "along y", "along z"};
  for (std::size_t i = 0; i < 3; ++i) {
    if (axis[i] == 1.0) return names[i];
  }
  return fmt::format("along ({:.3g}, {:.3g}, {:.3g})", axis[0], axis[1], axis[2]);
}

/// `the body "rod" has 3 natural frequencies along y (modes with more than half of their kinetic
/// energy in it), not 4`
/// @param owner  what they are of, as `the body "rod"`
/// @param count  how many count
inline std::string missing_mode(const std::string& owner, std::ptrdiff_t count,
                                const ModeChoice& choice) {
  const std::string which =
      choice.axis ? fmt::format(" {} (modes with more than half of their kinetic energy in it)",
                                describe_axis(*choice.axis))
                  : std::string();
  if (choice.number == ModeChoice::worst) {
    return fmt::format("{} has no mode that vibrates{}", owner, which);
  }
  return fmt::format("{} has {} natural frequenc{}{}, not {}", owner, count,
                     count == 1 ? "y" : "ies", which, choice.number + 1);
}

/// @throws InputError; of modes along an axis SimulationError: how many there are changes with the
///         design
[[noreturn]] inline void refuse_mode(const std::string& owner, std::ptrdiff_t count,
                                     const ModeChoice& choice) {
  const std::string text = missing_mode(owner, count, choice);
  if (choice.axis) throw SimulationError(text);
  throw InputError(text);
}

}  // namespace pleuel
