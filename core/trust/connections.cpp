#include "core/trust/connections.hpp"

#include <algorithm>

#include "core/scene/body_groups.hpp"

namespace pleuel {

std::set<std::string> grounded_bodies(const Scene& scene) {
  const BodyGroups groups(scene);
  std::set<std::string> grounded;
  for (const Body& body : scene.bodies) {
    if (groups.is_grounded(groups.of(body.name))) grounded.insert(body.name);
  }
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
