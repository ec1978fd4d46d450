#include "core/scene/reading/placement_check.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/scene/reading/geometry.hpp"
#include "core/scene/reading/limits.hpp"
#include "core/scene/reading/scene_reader.hpp"

namespace pleuel {
namespace {

/// Points may be off a beam by this share of its length, and off a point mass by this share of the
/// scene: far more than what rounding of written numbers costs, far less than what is meant.
constexpr double placement_tolerance = 1e-6;

/// A point that belongs to a body.
struct PlacedPoint {
  JsonNode node;
  const Point* point;
  const Body* body;  ///< null: the ground, which is everywhere
};

/// Two points that define a direction.
struct PointPair {
  JsonNode node;
  const Point *first, *second;
  std::string rule;
};

struct Places {
  std::vector<PlacedPoint> points;
  std::vector<PointPair> pairs;
};

void add_joint(const JsonNode& node, const Scene& scene, const Joint& joint, Places& places) {
  const bool is_distance = joint.type == JointType::distance;
  const JsonNode at = node.at("at"), second = is_distance ? node.at("to") : at;
  places.points.push_back({at, &joint.at, find_named(scene.bodies, joint.bodies[0])});
  places.points.push_back(
      {second, is_distance ? &joint.to : &joint.at, find_named(scene.bodies, joint.bodies[1])});
  if (is_distance) {
    places.pairs.push_back({second, &joint.at, &joint.to, "must not be the same point as \"at\""});
  }
}

void add_load(const JsonNode& node, const Scene& scene, const Load& load, Places& places) {
  if (const auto* force = std::get_if<PointForce>(&load.element)) {
    places.points.push_back({node.at("at"), &force->at, find_named(scene.bodies, force->body)});
  } else if (const auto* torque = std::get_if<PointTorque>(&load.element)) {
    places.points.push_back({node.at("at"), &torque->at, find_named(scene.bodies, torque->body)});
  } else if (const auto* spring = std::get_if<SpringDamper>(&load.element)) {
    const std::vector<JsonNode> ends = node.at("at").items();
    for (std::size_t end : {0U, 1U}) {
      places.points.push_back(
          {ends[end], &spring->at[end], find_named(scene.bodies, spring->bodies[end])});
    }
    places.pairs.push_back(
        {node.at("at"), &spring->at[0], &spring->at[1], "must be two different points"});
  }
}

Places places_of(const JsonNode& node, const Scene& scene) {
  Places places;
  for (const Joint& joint : scene.joints) {
    add_joint(node.at("joints").at(joint.name), scene, joint, places);
  }
  for (const Load& load : scene.loads) {
    add_load(node.at("loads").at(load.name), scene, load, places);
  }
  return places;
}

bool is_on_beam(const BeamBody& beam, double share, const Eigen::Vector3d& at,
                const Design<double>& design) {
  const double length = (position(beam.to, design) - position(beam.from, design)).stableNorm();
  return (at - point_at(beam, share, design)).stableNorm() <= placement_tolerance * length;
}

void check_on_beam(const PlacedPoint& place, const BeamBody& beam,
                   const std::vector<Sample>& samples) {
  const Design<double>& start = samples.front().design;
  const Eigen::Vector3d at_start = position(*place.point, start);
  const double share = nearest_share(beam, at_start, start);
  const std::string& name = place.body->name;
  if (!is_on_beam(beam, share, at_start, start)) {
    place.node.fail(
        fmt::format("must be on the axis of the beam \"{}\", the nearest point is {} [m], got {}",
                    name, describe(point_at(beam, share, start)), describe(at_start)));
  }
  for (const Sample& sample : samples) {
    const Eigen::Vector3d at = position(*place.point, sample.design);
    if (is_on_beam(beam, share, at, sample.design)) continue;
    place.node.fail(fmt::format(
        "must stay at the share {:.6g} of the length of the beam \"{}\", which is {} [m], got {}{}",
        share, name, describe(point_at(beam, share, sample.design)), describe(at), sample.where));
  }
}

/// In the axes of the body frame at the start.
void check_on_imported(const PlacedPoint& place, const ImportedBody& body,
                       const Design<double>& start) {
  const BodyConstants& constants = body.file->constants;
  const Eigen::Vector3d at = local_point(body, position(*place.point, start), start);
  const BodyPlace& nearest = constants.places[nearest_place(constants, at)];
  if ((at - nearest.position).stableNorm() <= placement_tolerance * size_of(constants)) return;
  place.node.fail(fmt::format(
      "must be at a place of the body \"{}\"; in its axes, the nearest one is \"{}\" at "
      "{} [m], got {}",
      place.body->name, nearest.name, describe(nearest.position), describe(at)));
}

void check_on_mass(const PlacedPoint& place, const PointMass& mass, const Scene& scene,
                   const std::vector<Sample>& samples) {
  for (const Sample& sample : samples) {
    const Eigen::Vector3d at = position(*place.point, sample.design);
    const Eigen::Vector3d point = position(mass.at, sample.design);
    const double tolerance = placement_tolerance * extent(scene, sample.design);
    if ((at - point).stableNorm() <= tolerance) continue;
    place.node.fail(fmt::format("must be where the point mass \"{}\" is, {} [m], got {}{}",
                                place.body->name, describe(point), describe(at), sample.where));
  }
}

void check_pair(const PointPair& pair, const std::vector<Sample>& samples) {
  for (const Sample& sample : samples) {
    const Eigen::Vector3d first = position(*pair.first, sample.design);
    const Eigen::Vector3d second = position(*pair.second, sample.design);
    const double size = std::max(first.stableNorm(), second.stableNorm());
    if ((second - first).stableNorm() > rounding_tolerance * size) continue;
    pair.node.fail_with_value(pair.rule, sample.where);
  }
}

}  // namespace

void check_placement(const JsonNode& node, const Scene& scene, const std::vector<Sample>& samples) {
  const Places places = places_of(node, scene);
  for (const PlacedPoint& place : places.points) {
    if (place.body == nullptr) continue;
    if (const auto* beam = std::get_if<BeamBody>(&place.body->shape)) {
      if (!beam->is_rigid) check_on_beam(place, *beam, samples);
    } else if (const auto* mass = std::get_if<PointMass>(&place.body->shape)) {
      check_on_mass(place, *mass, scene, samples);
    } else if (const auto* imported = std::get_if<ImportedBody>(&place.body->shape)) {
      check_on_imported(place, *imported, samples.front().design);
    }
  }
  for (const PointPair& pair : places.pairs) check_pair(pair, samples);
}

}  // namespace pleuel
