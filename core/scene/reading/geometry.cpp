#include "core/scene/reading/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace pleuel {
namespace {

/// Share of the beam's length that each segment takes.
std::vector<double> segment_shares(const BeamBody& beam) {
  double elements = 0.0;
  for (const Segment& segment : beam.segments) elements += segment.elements;
  std::vector<double> shares;
  for (const Segment& segment : beam.segments) {
    shares.push_back(segment.fraction.value_or(segment.elements / elements));
  }
  return shares;
}

/// The node nearest to a place along the beam, 0 … 1; nodes are equally spaced inside a segment.
double nearest_fraction(const BeamBody& beam, double place) {
  const std::vector<double> shares = segment_shares(beam);
  double nearest = 0.0, start = 0.0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const double elements = beam.segments[i].elements;
    const double steps = std::clamp((place - start) / shares[i] * elements, 0.0, elements);
    const double node = start + shares[i] * std::round(steps) / elements;
    if (std::abs(node - place) < std::abs(nearest - place)) nearest = node;
    start += shares[i];
  }
  return nearest;
}

std::vector<Eigen::Vector3d> all_places(const Scene& scene, const Design<double>& design) {
  std::vector<Eigen::Vector3d> places;
  for (const Body& body : scene.bodies) {
    if (const auto* beam = std::get_if<BeamBody>(&body.shape)) {
      places.push_back(position(beam->from, design));
      places.push_back(position(beam->to, design));
    } else if (const auto* rigid = std::get_if<RigidBody>(&body.shape)) {
      places.push_back(position(rigid->at, design));
    } else if (const auto* point = std::get_if<PointMass>(&body.shape)) {
      places.push_back(position(point->at, design));
    }
  }
  for (const Joint& joint : scene.joints) places.push_back(position(joint.at, design));
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

Eigen::Vector3d nearest_node(const BeamBody& beam, const Eigen::Vector3d& place,
                             const Design<double>& design) {
  const Eigen::Vector3d from = position(beam.from, design);
  const Eigen::Vector3d axis = position(beam.to, design) - from;
  const double length = axis.stableNorm();
  const double along = (place - from).dot(axis / length) / length;
  return from + axis * nearest_fraction(beam, along);
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
