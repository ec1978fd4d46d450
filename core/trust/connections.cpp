#include "core/trust/connections.hpp"

#include <algorithm>
#include <array>

namespace pleuel {

std::set<std::string> grounded_bodies(const Scene& scene) {
  std::vector<std::array<std::string, 2>> ties;
  for (const Joint& joint : scene.joints) ties.push_back(joint.bodies);
  for (const Load& load : scene.loads) {
    if (const auto* spring = std::get_if<SpringDamper>(&load.element)) {
      ties.push_back(spring->bodies);
    }
  }
  std::set<std::string> grounded = {ground_name};
  for (std::size_t size = 0; size != grounded.size();) {
    size = grounded.size();
    for (const auto& [first, second] : ties) {
      if (grounded.contains(first) || grounded.contains(second)) {
        grounded.insert({first, second});
      }
    }
  }
  grounded.erase(ground_name);
  return grounded;
}

bool has_given_velocity(const Body& body, const std::vector<double>& design) {
  const auto is_given = [&](const Number& number) { return resolve(number, design) != 0.0; };
  return std::any_of(body.velocity.begin(), body.velocity.end(), is_given) ||
         std::any_of(body.angular_velocity.begin(), body.angular_velocity.end(), is_given);
}

bool has_load(const Scene& scene, const std::string& body) {
  return std::any_of(scene.loads.begin(), scene.loads.end(), [&](const Load& load) {
    const auto* force = std::get_if<PointForce>(&load.element);
    const auto* torque = std::get_if<PointTorque>(&load.element);
    return (force && force->body == body) || (torque && torque->body == body);
  });
}

}  // namespace pleuel
