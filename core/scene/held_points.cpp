#include "core/scene/held_points.hpp"

namespace pleuel {

std::vector<AttachedPoint> attached_points(const Scene& scene, const std::string& body) {
  std::vector<AttachedPoint> points;
  const auto add_held = [&](const auto& holder) {
    visit_held_points(holder, [&](const std::string& of, const Point& at, const PointKey&) {
      if (of == body) points.push_back({holder.name, at});
    });
  };
  for (const Joint& joint : scene.joints) add_held(joint);
  for (const Load& load : scene.loads) add_held(load);
  for (const Body& one : scene.bodies) {
    if (one.name != body) continue;
    for (const InitialDeflection& given : one.initial_deflections) {
      points.push_back({"initial deflection", given.at});
    }
  }
  return points;
}

}  // namespace pleuel
