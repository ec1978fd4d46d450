#include "core/scene/reading/placement_check.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/scene/joint_kind.hpp"
#include "core/scene/reading/beam_places.hpp"
#include "core/scene/reading/geometry.hpp"
#include "core/scene/reading/limits.hpp"
#include "core/scene/reading/placed_points.hpp"
#include "core/scene/reading/scene_reader.hpp"

namespace pleuel {
namespace {

/// Two points that define a direction.
struct PointPair {
  JsonNode node;
  const Point *first, *second;
  std::string rule;
};

/// The node of a placed point.
JsonNode node_of(const JsonNode& scene, const PlacedPoint& place) {
  JsonNode node = scene;
  for (const std::string& key : place.path) {
    node = node.value().is_array() ? node.items().at(std::stoul(key)) : node.at(key);
  }
  return node;
}

std::vector<PointPair> pairs_of(const JsonNode& node, const Scene& scene) {
  std::vector<PointPair> pairs;
  for (const Joint& joint : scene.joints) {
    if (!kind_of(joint.type).has_length()) continue;
    pairs.push_back({node.at("joints").at(joint.name).at("to"), &joint.at, &joint.to,
                     "must not be the same point as \"at\""});
  }
  for (const Load& load : scene.loads) {
    const JsonNode place = node.at("loads").at(load.name);
    if (const auto* spring = std::get_if<SpringDamper>(&load.element)) {
      pairs.push_back(
          {place.at("at"), &spring->at[0], &spring->at[1], "must be two different points"});
    }
    const auto* force = std::get_if<PointForce>(&load.element);
    if (force == nullptr || !force->to) continue;
    pairs.push_back(
        {place.at("to"), &force->at, &*force->to, "must not be the same point as \"at\""});
  }
  return pairs;
}

void check_on_beam(const JsonNode& node, const PlacedPoint& place, PlacesOfBeams& places,
                   const std::vector<SampleDesign>& samples) {
  const auto& beam = std::get<BeamBody>(place.body->shape);
  const Design<double>& start = samples.front().design;
  const Eigen::Vector3d at_start = position(*place.point, start);
  const double share = nearest_share(beam, at_start, start);
  if (!is_on_beam(beam, share, at_start, start)) {
    node.fail(
        fmt::format("must be on the axis of the beam \"{}\", the nearest point is {} [m], got {}",
                    place.body->name, describe(point_at(beam, share, start)), describe(at_start)));
  }
  if (samples.size() == 1) return;  // nothing varies
  const BeamPlaces& of_beam = places.of(*place.body);
  for (const SampleDesign& sample : samples) {
    const auto found = of_beam.find_misplaced(*place.point, sample.design);
    if (!found) continue;
    node.fail(fmt::format("{}, got {}{}", *found, describe(position(*place.point, sample.design)),
                          sample.where));
  }
}

void check_on_imported(const JsonNode& node, const PlacedPoint& place,
                       const std::vector<SampleDesign>& samples) {
  const Design<double>& start = samples.front().design;
  for (const SampleDesign& sample : samples) {
    const auto found = find_off_place(*place.body, *place.point, start, sample.design);
    if (found) node.fail(*found + sample.where);
  }
}

void check_on_mass(const JsonNode& node, const PlacedPoint& place, const PointMass& mass,
                   const Scene& scene, const std::vector<SampleDesign>& samples) {
  for (const SampleDesign& sample : samples) {
    const Eigen::Vector3d at = position(*place.point, sample.design);
    if (is_on_mass(mass, at, scene, sample.design)) continue;
    const Eigen::Vector3d point = position(mass.at, sample.design);
    node.fail(fmt::format("must be where the point mass \"{}\" is, {} [m], got {}{}",
                          place.body->name, describe(point), describe(at), sample.where));
  }
}

void check_pair(const PointPair& pair, const std::vector<SampleDesign>& samples) {
  for (const SampleDesign& sample : samples) {
    const Eigen::Vector3d first = position(*pair.first, sample.design);
    const Eigen::Vector3d second = position(*pair.second, sample.design);
    const double size = std::max(first.stableNorm(), second.stableNorm());
    if ((second - first).stableNorm() > rounding_tolerance * size) continue;
    pair.node.fail_with_value(pair.rule, sample.where);
  }
}

}  // namespace

void check_placement(const JsonNode& node, const Scene& scene,
                     const std::vector<SampleDesign>& samples) {
  PlacesOfBeams places(scene, samples.front().design);
  for (const PlacedPoint& place : placed_points(scene)) {
    if (place.body == nullptr) continue;
    const JsonNode at = node_of(node, place);
    if (const auto* beam = std::get_if<BeamBody>(&place.body->shape)) {
      if (!beam->is_rigid) check_on_beam(at, place, places, samples);
    } else if (const auto* mass = std::get_if<PointMass>(&place.body->shape)) {
      check_on_mass(at, place, *mass, scene, samples);
    } else if (std::holds_alternative<ImportedBody>(place.body->shape)) {
      check_on_imported(at, place, samples);
    }
  }
  for (const PointPair& pair : pairs_of(node, scene)) check_pair(pair, samples);
}

}  // namespace pleuel
