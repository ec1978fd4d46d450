#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pleuel {

/// The place of the first thing of this name; nothing if there is none.
template <class Named>
std::optional<std::size_t> index_of_named(const std::vector<Named>& things,
                                          const std::string& name) {
  for (std::size_t i = 0; i < things.size(); ++i) {
    if (things[i].name == name) return i;
  }
  return std::nullopt;
}

/// The thing of this name, or null.
template <class Named>
const Named* find_named(const std::vector<Named>& things, const std::string& name) {
  const std::optional<std::size_t> index = index_of_named(things, name);
  return index ? &things[*index] : nullptr;
}

template <class Named>
Named* find_named(std::vector<Named>& things, const std::string& name) {
  return const_cast<Named*>(find_named(std::as_const(things), name));
}

}  // namespace pleuel
