#include "core/model/attached_points.hpp"

#include "core/scene/held_points.hpp"

namespace pleuel {

std::vector<AttachedPoint> attached_points(const Scene& scene) {
  std::vector<AttachedPoint> points;
  const auto add_held = [&](const auto& holder) {
    visit_held_points(holder, [&](const std::string& body, const Point& at, const PointKey&) {
      points.push_back({holder.name, body, at});
    });
  };
  for (const Joint& joint : scene.joints) add_held(joint);
  for (const Load& load : scene.loads) add_held(load);
  for (const Body& body : scene.bodies) {
    for (const InitialDeflection& one : body.initial_deflections) {
      points.push_back({"initial deflection", body.name, one.at});
    }
  }
  return points;
}

}  // namespace pleuel
