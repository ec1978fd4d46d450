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
  for (const Body& body : scene.bodies) {
    if (const auto* beam = std::get_if<BeamBody>(&body.shape)) {
      places.push_back(position(beam->from, design));
      places.push_back(position(beam->to, design));
    } else if (const auto* rigid = std::get_if<RigidBody>(&body.shape)) {
      places.push_back(position(rigid->at, design));
    } else if (const auto* imported = std::get_if<ImportedBody>(&body.shape)) {
      places.push_back(position(imported->from, design));
      places.push_back(position(imported->to, design));
    } else if (const auto* point = std::get_if<PointMass>(&body.shape)) {
      places.push_back(position(point->at, design));
    }
  }
  for (const Joint& joint : scene.joints) {
    visit_held_places(
        joint, [&](const Point& at, const PointKey&) { places.push_back(position(at, design)); });
  }
  return places;
}

/// A coordinate for a message, without the last digits, which are rounding.
std::string shown(double coordinate) {
  return fmt::format("{:.9g}", coordinate + 0.0);
}

}  // namespace

Eigen::Vector3d position(const Point& point, const Design<double>& design) {
  return {resolve(point[0], design), resolve(point[1], design), resolve(point[2], design)};
}

Eigen::Vector3d point_at(const BeamBody& beam, double share, const Design<double>& design) {
  return (1.0 - share) * position(beam.from, design) + share * position(beam.to, design);
}

double nearest_share(const BeamBody& beam, const Eigen::Vector3d& place,
                     const Design<double>& design) {
  const Eigen::Vector3d from = position(beam.from, design);
  const Eigen::Vector3d axis = position(beam.to, design) - from;
  const double length = axis.stableNorm();
  return std::clamp((place - from).dot(axis / length) / length, 0.0, 1.0);
}

Eigen::Vector3d local_point(const ImportedBody& body, const Eigen::Vector3d& place,
                            const Design<double>& design) {
  return beam_axes(body.from, body.to, body.reference, design).transpose() *
         (place - position(body.from, design));
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
