#include "core/scene/reading/scene_check.hpp"

#include <algorithm>
#include <set>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/scene/body_rules.hpp"
#include "core/scene/held_points.hpp"
#include "core/scene/reading/body_places.hpp"
#include "core/scene/reading/mistakes.hpp"
#include "core/scene/reading/scene_reader.hpp"
#include "core/scene/reading/section_choices.hpp"
#include "core/scene/reading/variable_reader.hpp"

namespace pleuel {

namespace {

/// A beam, or a body that lies as one.
template <class Beam>
void check_axes(const JsonNode& node, const Beam& beam, const SampleDesign& sample) {
  const Eigen::Vector3d axis =
      resolve_point(beam.to, sample.design) - resolve_point(beam.from, sample.design);
  const double size = std::max(resolve_point(beam.to, sample.design).stableNorm(),
                               resolve_point(beam.from, sample.design).stableNorm());
  if (axis.stableNorm() <= rounding_tolerance * size) {
    node.fail("has zero length: \"from\" and \"to\" are the same point" + sample.where);
  }
  if (!beam.reference) return;
  const Eigen::Vector3d reference((*beam.reference)[0], (*beam.reference)[1], (*beam.reference)[2]);
  if (axis.stableNormalized().cross(reference.stableNormalized()).norm() <= rounding_tolerance) {
    node.at("reference").fail_with_value("must not be parallel to the beam", sample.where);
  }
}

void check_sections(const JsonNode& node, const BeamBody& beam, const Design<double>& start) {
  const std::optional<JsonNode> list = node.find("segments");
  for (std::size_t i = 0; i < beam.segments.size(); ++i) {
    const JsonNode segment = list ? list->items()[i] : node;
    check_section(segment.at("section"), beam.segments[i].section, start);
  }
}

void check_inertia(const JsonNode& node, const RigidBody& body, const Design<double>& start) {
  const JsonNode list = node.at("inertia");
  const auto is_zero = [&](const Number& entry) { return resolve(entry, start) == 0.0; };
  if (std::all_of(body.inertia.begin(), body.inertia.begin() + 3, is_zero)) {
    list.fail_with_value("must not be all zero (a body without inertia is a point-mass)");
  }
  if (const auto broken = inertia_complaint(body, start)) list.fail_with_value(*broken);
}

/// Derivatives belong to the design at which they were made.
void check_design(const JsonNode& node, const ImportedBody& body, const Design<double>& start) {
  if (body.maker) return;
  for (const ImportedVariable& of : body.variables) {
    const ConstantsDerivative& derivative = body.file->design[of.in_design];
    const double value = resolve(of.number, start);
    if (std::abs(value - derivative.value) <= rounding_tolerance * std::abs(derivative.value)) {
      continue;
    }
    node.at("file").fail(fmt::format(
        "names the file {} of the design {} = {:.12g} [{}], but the variable starts at {:.12g}",
        body.source, derivative.variable, derivative.value, derivative.unit, value));
  }
}

void check_bodies(const JsonNode& node, const Scene& scene,
                  const std::vector<SampleDesign>& samples) {
  for (const Body& body : scene.bodies) {
    const JsonNode place = node.at(body.name);
    if (const auto* beam = std::get_if<BeamBody>(&body.shape)) {
      for (const SampleDesign& sample : samples) check_axes(place, *beam, sample);
      check_sections(place, *beam, samples.front().design);
    } else if (const auto* rigid = std::get_if<RigidBody>(&body.shape)) {
      check_inertia(place, *rigid, samples.front().design);
    } else if (const auto* imported = std::get_if<ImportedBody>(&body.shape)) {
      for (const SampleDesign& sample : samples) check_axes(place, *imported, sample);
      check_design(place, *imported, samples.front().design);
    }
  }
}

/// What would set the elastic coordinates, too, or leaves none.
void check_deflections(const JsonNode& bodies, const ProblemFile& problem) {
  for (const Body& body : problem.scene.bodies) {
    if (body.initial_deflections.empty()) continue;
    const JsonNode node = bodies.at(body.name).at("initial_deflections");
    if (problem.simulation.quasi_static_start) {
      node.fail("cannot be given where /simulation/initial_state is \"quasi-static\"");
    }
    if (problem.simulation.period > 0.0) {
      node.fail("cannot be given where /simulation/initial_state is \"periodic\"");
    }
    if (problem.effects.elasticity == EffectChoice::off) {
      node.fail("cannot be given where /effects/elasticity is \"off\"");
    }
  }
}

constexpr double parallel_tolerance = 1e-9;  // sine of the angle between axes: rounding

void check_that_something_acts_on_every_body(const JsonNode& node, const Scene& scene) {
  std::set<std::string> touched;
  const auto touch = [&](const std::string& body, const Point&, const PointKey&) {
    touched.insert(body);
  };
  for (const Joint& joint : scene.joints) visit_held_points(joint, touch);
  for (const Load& load : scene.loads) visit_held_points(load, touch);
  for (const Body& body : scene.bodies) {
    if (touched.count(body.name) > 0) continue;
    node.at("bodies").at(body.name).fail("is not connected to anything by a joint or a load");
  }
}

void check_that_bodies_can_turn(const JsonNode& node, const Scene& scene, const Joint& joint) {
  for (const std::string& name : joint.bodies) {
    const Body* body = find_named(scene.bodies, name);
    if (body == nullptr || !std::holds_alternative<PointMass>(body->shape)) continue;
    node.fail(fmt::format("needs two bodies that can turn, but \"{}\" is a point mass", name));
  }
}

/// The coordinate of a joint that a load acts along, or is a function of.
std::optional<JointCoordinate> coordinate_of(const Load& load) {
  if (const auto* point = std::get_if<PointLoad>(&load.element)) return point->over;
  const auto* force = std::get_if<JointForce>(&load.element);
  if (force == nullptr) return std::nullopt;
  return JointCoordinate{force->joint, force->coordinate};
}

void check_turning(const JsonNode& node, const Scene& scene) {
  for (const Joint& joint : scene.joints) {
    if (!is_driven(joint, DrivenCoordinate::angle)) continue;
    check_that_bodies_can_turn(node.at("joints").at(joint.name).at("drive"), scene, joint);
  }
  for (const Load& load : scene.loads) {
    const std::optional<JointCoordinate> along = coordinate_of(load);
    if (!along || along->coordinate != DrivenCoordinate::angle) continue;
    check_that_bodies_can_turn(node.at("loads").at(load.name), scene,
                               *find_named(scene.joints, along->joint));
  }
}

bool have_same_bodies(const Joint& a, const Joint& b) {
  return a.bodies == b.bodies || (a.bodies[0] == b.bodies[1] && a.bodies[1] == b.bodies[0]);
}

bool have_parallel_axes(const Joint& a, const Joint& b) {
  const Eigen::Vector3d first(a.axis[0], a.axis[1], a.axis[2]);
  const Eigen::Vector3d second(b.axis[0], b.axis[1], b.axis[2]);
  return first.stableNormalized().cross(second.stableNormalized()).norm() <= parallel_tolerance;
}

/// Drives of distances, and of points on lines, may act side by side, as in a hexapod.
bool drive_the_same(const Joint& a, const Joint& b) {
  if (a.drive->coordinate != b.drive->coordinate) return false;
  if (!have_same_bodies(a, b) || !have_parallel_axes(a, b)) return false;
  return a.drive->coordinate == DrivenCoordinate::angle ||
         (kind_of(a.type).is_guide() && kind_of(b.type).is_guide());
}

void check_that_no_motion_is_driven_twice(const JsonNode& node, const Scene& scene) {
  for (std::size_t i = 0; i < scene.joints.size(); ++i) {
    const Joint& joint = scene.joints[i];
    if (!joint.drive) continue;
    for (std::size_t k = 0; k < i; ++k) {
      const Joint& other = scene.joints[k];
      if (!other.drive || !drive_the_same(joint, other)) continue;
      node.at("joints")
          .at(joint.name)
          .at("drive")
          .fail(fmt::format("prescribes the same motion as the drive of the joint \"{}\"",
                            other.name));
    }
  }
}

/// What needs no geometry of the design: a joint or a load acts on every body, what is driven or
/// loaded by an angle can turn, no motion is prescribed twice.
void check_mechanism(const JsonNode& node, const Scene& scene) {
  check_that_something_acts_on_every_body(node, scene);
  check_turning(node, scene);
  check_that_no_motion_is_driven_twice(node, scene);
}

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

/// Whether a spring may begin, and pass through, where both its ends are at one point.
bool has_no_length(const SpringDamper& spring) {
  const std::optional<Number>& length = spring.free_length;
  return length && !length->is_bound() && length->constant == 0.0;
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
    const auto* spring = std::get_if<SpringDamper>(&load.element);
    if (spring != nullptr && !has_no_length(*spring)) {
      pairs.push_back({place.at("at"), &spring->at[0], &spring->at[1],
                       "must be two different points where \"free_length\" is not 0"});
    }
    const auto* point = std::get_if<PointLoad>(&load.element);
    if (point == nullptr || !point->to) continue;
    pairs.push_back(
        {place.at("to"), &point->at, &*point->to, "must not be the same point as \"at\""});
  }
  return pairs;
}

void check_pair(const PointPair& pair, const std::vector<SampleDesign>& samples) {
  for (const SampleDesign& sample : samples) {
    const Eigen::Vector3d first = resolve_point(*pair.first, sample.design);
    const Eigen::Vector3d second = resolve_point(*pair.second, sample.design);
    const double size = std::max(first.stableNorm(), second.stableNorm());
    if ((second - first).stableNorm() > rounding_tolerance * size) continue;
    pair.node.fail_with_value(pair.rule, sample.where);
  }
}

/// Joints, loads and initial deflections are at points of their bodies, and the two points of a distance
/// or spring differ.
/// @param samples  the start design first
void check_placement(const JsonNode& node, const Scene& scene,
                     const std::vector<SampleDesign>& samples) {
  PlacesOnBodies places(scene, samples.front().design);
  for (const PlacedPoint& placed : placed_points(scene)) {
    for (const SampleDesign& sample : samples) {
      const auto found = places.find_misplaced(placed, sample.design, false);
      if (!found) continue;
      node_of(node, placed)
          .fail(fmt::format("{}, got {}{}", found->rule, describe(found->at), sample.where));
    }
  }
  for (const PointPair& pair : pairs_of(node, scene)) check_pair(pair, samples);
}

}  // namespace

void check_scene(const JsonNode& node, const ProblemFile& problem) {
  check_mechanism(node, problem.scene);
  const std::vector<SampleDesign> samples = sample_designs(problem.variables);
  check_bodies(node.at("bodies"), problem.scene, samples);
  check_placement(node, problem.scene, samples);
  check_deflections(node.at("bodies"), problem);
}

}  // namespace pleuel
