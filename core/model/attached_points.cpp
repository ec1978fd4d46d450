#include "core/model/attached_points.hpp"

#include "core/scene/joint_kind.hpp"

namespace pleuel {

std::vector<AttachedPoint> attached_points(const Scene& scene) {
  std::vector<AttachedPoint> points;
  for (const Joint& joint : scene.joints) {
    points.push_back({joint.name, joint.bodies[0], joint.at});
    points.push_back({joint.name, joint.bodies[1], second_point(joint)});
  }
  for (const Load& load : scene.loads) {
    if (const auto* force = std::get_if<PointForce>(&load.element)) {
      points.push_back({load.name, force->body, force->at});
    } else if (const auto* torque = std::get_if<PointTorque>(&load.element)) {
      points.push_back({load.name, torque->body, torque->at});
    } else if (const auto* spring = std::get_if<SpringDamper>(&load.element)) {
      for (std::size_t i = 0; i < 2; ++i) {
        points.push_back({load.name, spring->bodies[i], spring->at[i]});
      }
    }
  }
  for (const Body& body : scene.bodies) {
    for (const InitialDeflection& one : body.initial_deflections) {
      points.push_back({"initial deflection", body.name, one.at});
    }
  }
  return points;
}

}  // namespace pleuel
