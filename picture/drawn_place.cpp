#include "picture/drawn_place.hpp"

#include "core/model/beam_mesh.hpp"
#include "core/model/scene_geometry.hpp"

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
                       const Design<double>& start, const Design<double>& design) {
  DrawnPlace place;
  place.body = index_of(scene, body);
  place.point = resolve_point(at, design);
  if (place.body < 0) return place;
  const Body& holder = scene.bodies[place.body];
  if (const auto* beam = std::get_if<BeamBody>(&holder.shape)) {
    // A rigid beam holds points anywhere in space: those beside its axis are drawn from its frame.
    const double share = share_along(*beam, at, start);
    const Eigen::Vector3d from = resolve_point(beam->from, start),
                          to = resolve_point(beam->to, start);
    const Eigen::Vector3d there = resolve_point(at, start);
    const bool is_on_axis =
        (from + share * (to - from) - there).norm() <= 1e-6 * (to - from).norm();
    place.share = share;
    if (is_on_axis && share >= 0.0 && share <= 1.0) {
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
