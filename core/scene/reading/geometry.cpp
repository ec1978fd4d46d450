#include "core/scene/reading/geometry.hpp"

#include <algorithm>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/scene/body_chart.hpp"
#include "core/scene/held_points.hpp"

namespace pleuel {
namespace {

std::vector<Eigen::Vector3d> all_places(const Scene& scene, const Design<double>& design) {
  std::vector<Eigen::Vector3d> places;
  const auto add = [&](const Point& at, const PointKey&) {
    places.push_back(resolve_point(at, design));
  };
  for (const Body& body : scene.bodies) visit_body_points(body, add);
  for (const Joint& joint : scene.joints) visit_held_places(joint, add);
  return places;
}

/// A coordinate for a message, without the last digits, which are rounding.
std::string shown(double coordinate) {
  return fmt::format("{:.9g}", coordinate + 0.0);
}

}  // namespace

Eigen::Vector3d point_at(const BeamBody& beam, double share, const Design<double>& design) {
  return (1.0 - share) * resolve_point(beam.from, design) + share * resolve_point(beam.to, design);
}

double nearest_share(const BeamBody& beam, const Eigen::Vector3d& place,
                     const Design<double>& design) {
  const Eigen::Vector3d from = resolve_point(beam.from, design);
  const Eigen::Vector3d axis = resolve_point(beam.to, design) - from;
  const double length = axis.stableNorm();
  return std::clamp((place - from).dot(axis / length) / length, 0.0, 1.0);
}

Eigen::Vector3d local_point(const ImportedBody& body, const Eigen::Vector3d& place,
                            const Design<double>& design) {
  return beam_axes(body.from, body.to, body.reference, design).transpose() *
         (place - resolve_point(body.from, design));
}

double extent(const Scene& scene, const Design<double>& design) {
  const std::vector<Eigen::Vector3d> places = all_places(scene, design);
  Eigen::Vector3d least = places.front(), most = places.front();
  for (const Eigen::Vector3d& place : places) {
    least = least.cwiseMin(place);
    most = most.cwiseMax(place);
  }
  return (most - least).stableNorm();
}

std::string describe(const Eigen::Vector3d& place) {
  return fmt::format("({}, {}, {})", shown(place[0]), shown(place[1]), shown(place[2]));
}

}  // namespace pleuel
