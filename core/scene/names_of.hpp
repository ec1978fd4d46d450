#pragma once

#include <string>
#include <vector>

namespace pleuel {

/// Names of materials, bodies, joints, … in their order.
template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& things) {
  std::vector<std::string> names;
  for (const Named& thing : things) names.push_back(thing.name);
  return names;
}

}  // namespace pleuel
