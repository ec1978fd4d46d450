#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace pleuel {

/// The thing of this name, or null.
template <class Named>
const Named* find_named(const std::vector<Named>& things, const std::string& name) {
  const auto found = std::find_if(things.begin(), things.end(),
                                  [&name](const Named& thing) { return thing.name == name; });
  return found == things.end() ? nullptr : &*found;
}

template <class Named>
Named* find_named(std::vector<Named>& things, const std::string& name) {
  return const_cast<Named*>(find_named(std::as_const(things), name));
}

}  // namespace pleuel
