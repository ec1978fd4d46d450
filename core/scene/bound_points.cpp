#include "core/scene/bound_points.hpp"

#include <algorithm>
#include <functional>

#include "core/scene/reading/geometry.hpp"
#include "core/scene/reading/placed_points.hpp"

namespace pleuel {

std::vector<Eigen::Vector3d> bound_points(const Scene& scene, const Design<double>& design) {
  std::vector<Eigen::Vector3d> points;
  const auto add = [&](const Point& point) {
    if (std::any_of(point.begin(), point.end(), std::mem_fn(&Number::is_bound))) {
      points.push_back(position(point, design));
    }
  };
  for (const Body& body : scene.bodies) {
    if (const auto* beam = std::get_if<BeamBody>(&body.shape)) {
      add(beam->from);
      add(beam->to);
    } else if (const auto* imported = std::get_if<ImportedBody>(&body.shape)) {
      add(imported->from);
      add(imported->to);
    } else if (const auto* rigid = std::get_if<RigidBody>(&body.shape)) {
      add(rigid->at);
    } else {
      add(std::get<PointMass>(body.shape).at);
    }
  }
  for (const PlacedPoint& placed : placed_points(scene)) add(*placed.point);
  return points;
}

}  // namespace pleuel
