#include "core/scene/body_groups.hpp"

#include <array>

#include "core/base/disjoint_sets.hpp"
#include "core/base/int_size.hpp"

namespace pleuel {

namespace {

/// Of joints and springs.
std::vector<std::array<std::string, 2>> ties_of(const Scene& scene) {
  std::vector<std::array<std::string, 2>> ties;
  for (const Joint& joint : scene.joints) ties.push_back(joint.bodies);
  for (const Load& load : scene.loads) {
    if (const auto* spring = std::get_if<SpringDamper>(&load.element)) {
      ties.push_back(spring->bodies);
    }
  }
  return ties;
}

}  // namespace

BodyGroups::BodyGroups(const Scene& scene) {
  std::unordered_map<std::string, int> numbers;
  for (const Body& body : scene.bodies) {
    numbers.try_emplace(body.name, int_size(numbers));
  }
  const auto ties = ties_of(scene);
  DisjointSets sets(numbers.size());
  for (const auto& [one, other] : ties) {
    if (one != ground_name && other != ground_name) sets.join(numbers.at(one), numbers.at(other));
  }
  for (const auto& [name, number] : numbers) groups_[name] = sets.find(number);
  for (const auto& [one, other] : ties) {
    if (one == ground_name && other != ground_name) grounded_.insert(of(other));
    if (other == ground_name && one != ground_name) grounded_.insert(of(one));
  }
}

}  // namespace pleuel
