#pragma once

#include <optional>
#include <string>

#include <fmt/format.h>

namespace pleuel {

/// Which natural frequency is meant.
struct ModeChoice {
  int number = 0;  ///< from 0 for the lowest of those that count
  /// 0 … 2: only modes along x, y or z count, with more than half of their kinetic energy. Axes are
  /// those of the body whose frequency it is, and global ones of a mechanism.
  std::optional<int> axis = {};
};

/// `the body "rod" has 3 natural frequencies along y, not 4`
/// @param owner  what they are of, as `the body "rod"`
/// @param count  how many count
inline std::string missing_mode(const std::string& owner, std::ptrdiff_t count,
                                const ModeChoice& choice) {
  constexpr const char* axes[] = {" along x", " along y", " along z"};
  return fmt::format("{} has {} natural frequenc{}{}, not {}", owner, count,
                     count == 1 ? "y" : "ies", choice.axis ? axes[*choice.axis] : "",
                     choice.number + 1);
}

}  // namespace pleuel
