#include "picture/drawn_place.hpp"

#include <algorithm>

#include "core/base/eager_matrices.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/scene/beam_mesh.hpp"

namespace pleuel {

namespace {

int index_of(const Scene& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

}  // namespace

DrawnPlace drawn_place(const Scene& scene, const std::string& body, const Point& at,
                       const Design<double>& design) {
  DrawnPlace place;
  place.body = index_of(scene, body);
  place.point = resolve_point(at, design);
  if (place.body < 0) return place;
  const Body& holder = scene.bodies[place.body];
  if (const auto* beam = std::get_if<BeamBody>(&holder.shape)) {
    // A rigid beam holds points anywhere in space: those beside its axis are drawn from its frame.
    constexpr double rounding = 1e-6;
    const double share = share_along(*beam, at, design);
    const Eigen::Vector3d from = resolve_point(beam->from, design);
    const Eigen::Vector3d way = resolve_point(beam->to, design) - from;
    const bool is_on_axis = (from + share * way - place.point).norm() <= rounding * way.norm();
    if (is_on_axis && share >= -rounding && share <= 1.0 + rounding) {
      place.share = std::clamp(share, 0.0, 1.0);
      place.point.setZero();
      return place;
    }
    place.share = -1.0;
  }
  const Pose<double> pose = body_pose(holder, design);
  place.point = pose.rotation.transpose() * (place.point - pose.origin);
  return place;
}

}  // namespace pleuel
