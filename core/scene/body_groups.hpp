#pragma once

#include <set>
#include <string>
#include <unordered_map>

#include "core/scene/scene.hpp"

namespace pleuel {

/// Bodies that joints and springs tie to each other: what happens to one of a group concerns the
/// others, and no other group. The ground, which does not move, makes no two groups one.
class BodyGroups {
 public:
  explicit BodyGroups(const Scene& scene);

  /// The number of the group of a body of the scene.
  int of(const std::string& body) const { return groups_.at(body); }
  /// Whether a group is tied to the ground.
  bool is_grounded(int group) const { return grounded_.contains(group); }

 private:
  std::unordered_map<std::string, int> groups_;
  std::set<int> grounded_;
};

}  // namespace pleuel
