#pragma once

#include <cstddef>

namespace pleuel {

/// Whether each row of a table of kinds stands where the value of its `type` says.
template <class Kind, std::size_t count>
constexpr bool are_in_order(const Kind (&kinds)[count]) {
  for (std::size_t i = 0; i < count; ++i) {
    if (static_cast<std::size_t>(kinds[i].type) != i) return false;
  }
  return true;
}

}  // namespace pleuel
