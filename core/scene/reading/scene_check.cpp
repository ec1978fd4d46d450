#include "core/scene/reading/scene_check.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "core/scene/reading/geometry.hpp"

namespace pleuel {
namespace {

/// Joints may miss their node by this share of the beam's length, point masses by this share of the
/// scene: far more than what rounding of written numbers costs, far less than what is meant.
constexpr double placement_tolerance = 1e-6;
/// Directions closer than this, and inertia less than zero by no more than this, are rounding.
constexpr double rounding_tolerance = 1e-9;

/// A design for which the scene must make sense.
struct Sample {
  Design<double> design;
  std::string where;  ///< end of a message: empty for the start design
};

std::vector<Sample> make_samples(const std::vector<DesignVariable>& variables) {
  Sample start;
  for (const DesignVariable& variable : variables) start.design.push_back(variable.start);
  std::vector<Sample> samples = {start};
  for (std::size_t i = 0; i < variables.size(); ++i) {
    for (const auto& [bound, word] :
         {std::pair(variables[i].lower, "lower"), std::pair(variables[i].upper, "upper")}) {
      Sample sample = start;
      sample.design[i] = bound;
      sample.where =
          fmt::format(", with the variable \"{}\" at its {} bound", variables[i].name, word);
      samples.push_back(sample);
    }
  }
  return samples;
}

const Body* find_body(const Scene& scene, const std::string& name) {
  const auto body = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                 [&name](const Body& candidate) { return candidate.name == name; });
  return body == scene.bodies.end() ? nullptr : &*body;
}

void check_that_joints_hold_every_body(const JsonNode& node, const Scene& scene) {
  for (const Body& body : scene.bodies) {
    const bool is_held =
        std::any_of(scene.joints.begin(), scene.joints.end(), [&body](const Joint& joint) {
          return joint.bodies[0] == body.name || joint.bodies[1] == body.name;
        });
    if (!is_held) node.at("bodies").at(body.name).fail("is not connected to anything by a joint");
  }
}

void check_that_driven_bodies_can_turn(const JsonNode& node, const Scene& scene) {
  for (const Joint& joint : scene.joints) {
    if (!joint.drive) continue;
    for (const std::string& name : joint.bodies) {
      const Body* body = find_body(scene, name);
      if (body == nullptr || !std::holds_alternative<PointMass>(body->shape)) continue;
      node.at("joints")
          .at(joint.name)
          .at("drive")
          .fail(fmt::format("needs two bodies that can turn, but \"{}\" is a point mass", name));
    }
  }
}

void check_beam(const JsonNode& node, const BeamBody& beam, const Sample& sample) {
  const Eigen::Vector3d axis =
      position(beam.to, sample.design) - position(beam.from, sample.design);
  const double size = std::max(position(beam.to, sample.design).stableNorm(),
                               position(beam.from, sample.design).stableNorm());
  if (axis.stableNorm() <= rounding_tolerance * size) {
    node.fail("has zero length: \"from\" and \"to\" are the same point" + sample.where);
  }
  if (!beam.reference) return;
  const Eigen::Vector3d reference((*beam.reference)[0], (*beam.reference)[1], (*beam.reference)[2]);
  if (axis.stableNormalized().cross(reference.stableNormalized()).norm() <= rounding_tolerance) {
    node.at("reference").fail_with_value("must not be parallel to the beam", sample.where);
  }
}

/// Only at the start: bounds that let walls and diameters cross may have a linear constraint
/// between them.
void check_tubes(const JsonNode& node, const BeamBody& beam, const Design<double>& start) {
  for (std::size_t i = 0; i < beam.segments.size(); ++i) {
    const auto* tube = std::get_if<TubeSection>(&beam.segments[i].section);
    if (tube == nullptr) continue;
    const double thickness = resolve(tube->thickness, start);
    const double radius = 0.5 * resolve(tube->outer_diameter, start);
    if (thickness <= radius * (1.0 + rounding_tolerance)) continue;
    const std::optional<JsonNode> list = node.find("segments");
    const JsonNode segment = list ? list->items()[i] : node;
    segment.at("section")
        .at("thickness")
        .fail(fmt::format("must not exceed the radius {:g} [m] of the tube, got {:g}", radius,
                          thickness));
  }
}

void check_inertia(const JsonNode& node, const RigidBody& body, const Design<double>& start) {
  const auto entry = [&](std::size_t i) { return resolve(body.inertia[i], start); };
  Eigen::Matrix3d inertia;
  inertia << entry(0), entry(3), entry(4), entry(3), entry(1), entry(5), entry(4), entry(5),
      entry(2);
  const JsonNode list = node.at("inertia");
  if (inertia.trace() == 0.0)
    list.fail_with_value("must not be all zero (a body without inertia is a point-mass)");
  const Eigen::Vector3d principal = inertia.selfadjointView<Eigen::Lower>().eigenvalues();
  if (principal.minCoeff() < -rounding_tolerance * inertia.trace()) {
    list.fail_with_value("must have no negative principal moment (xx, yy, zz, xy, xz, yz)");
  }
}

void check_bodies(const JsonNode& node, const Scene& scene, const std::vector<Sample>& samples) {
  for (const Body& body : scene.bodies) {
    const JsonNode place = node.at(body.name);
    if (const auto* beam = std::get_if<BeamBody>(&body.shape)) {
      for (const Sample& sample : samples) check_beam(place, *beam, sample);
      check_tubes(place, *beam, samples.front().design);
    } else if (const auto* rigid = std::get_if<RigidBody>(&body.shape)) {
      check_inertia(place, *rigid, samples.front().design);
    }
  }
}

void check_on_node(const JsonNode& node, const Body& body, const Eigen::Vector3d& at,
                   const Sample& sample) {
  const auto& beam = std::get<BeamBody>(body.shape);
  const Eigen::Vector3d nearest = nearest_node(beam, at, sample.design);
  const double length =
      (position(beam.to, sample.design) - position(beam.from, sample.design)).stableNorm();
  if ((at - nearest).stableNorm() <= placement_tolerance * length) return;
  node.fail(fmt::format("must be at a node of the beam \"{}\", the nearest is {} [m], got {}{}",
                        body.name, describe(nearest), describe(at), sample.where));
}

void check_on_point(const JsonNode& node, const Body& body, const Eigen::Vector3d& at,
                    double tolerance, const Sample& sample) {
  const Eigen::Vector3d point = position(std::get<PointMass>(body.shape).at, sample.design);
  if ((at - point).stableNorm() <= tolerance) return;
  node.fail(fmt::format("must be where the point mass \"{}\" is, {} [m], got {}{}", body.name,
                        describe(point), describe(at), sample.where));
}

void check_joints(const JsonNode& node, const Scene& scene, const Sample& sample) {
  const double tolerance = placement_tolerance * extent(scene, sample.design);
  for (const Joint& joint : scene.joints) {
    const JsonNode place = node.at(joint.name).at("at");
    const Eigen::Vector3d at = position(joint.at, sample.design);
    for (const std::string& name : joint.bodies) {
      const Body* body = find_body(scene, name);
      if (body == nullptr) continue;  // the ground is everywhere
      if (std::holds_alternative<BeamBody>(body->shape)) check_on_node(place, *body, at, sample);
      if (std::holds_alternative<PointMass>(body->shape)) {
        check_on_point(place, *body, at, tolerance, sample);
      }
    }
  }
}

}  // namespace

void check_scene(const JsonNode& node, const ProblemFile& problem) {
  check_that_joints_hold_every_body(node, problem.scene);
  check_that_driven_bodies_can_turn(node, problem.scene);
  const std::vector<Sample> samples = make_samples(problem.variables);
  check_bodies(node.at("bodies"), problem.scene, samples);
  for (const Sample& sample : samples) check_joints(node.at("joints"), problem.scene, sample);
}

}  // namespace pleuel
