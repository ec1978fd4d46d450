#include "core/scene/reading/placed_points.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/find_named.hpp"
#include "core/scene/joint_kind.hpp"
#include "core/scene/reading/geometry.hpp"
#include "core/scene/reading/limits.hpp"

namespace pleuel {

namespace {

void add_joint(const Scene& scene, const Joint& joint, std::vector<PlacedPoint>& points) {
  points.push_back(
      {{"joints", joint.name, "at"}, &joint.at, find_named(scene.bodies, joint.bodies[0])});
  points.push_back({{"joints", joint.name, kind_of(joint.type).has_length() ? "to" : "at"},
                    &second_point(joint),
                    find_named(scene.bodies, joint.bodies[1])});
}

void add_load(const Scene& scene, const Load& load, std::vector<PlacedPoint>& points) {
  if (const auto* force = std::get_if<PointForce>(&load.element)) {
    points.push_back(
        {{"loads", load.name, "at"}, &force->at, find_named(scene.bodies, force->body)});
  } else if (const auto* torque = std::get_if<PointTorque>(&load.element)) {
    points.push_back(
        {{"loads", load.name, "at"}, &torque->at, find_named(scene.bodies, torque->body)});
  } else if (const auto* spring = std::get_if<SpringDamper>(&load.element)) {
    for (const std::size_t end : {0U, 1U}) {
      points.push_back({{"loads", load.name, "at", std::to_string(end)},
                        &spring->at[end],
                        find_named(scene.bodies, spring->bodies[end])});
    }
  }
}

void add_deflections(const Body& body, std::vector<PlacedPoint>& points) {
  for (std::size_t i = 0; i < body.initial_deflections.size(); ++i) {
    points.push_back({{"bodies", body.name, "initial_deflections", std::to_string(i), "at"},
                      &body.initial_deflections[i].at,
                      &body});
  }
}

}  // namespace

std::string PlacedPoint::pointer() const {
  return fmt::format("/scene/{}", fmt::join(path, "/"));
}

std::vector<PlacedPoint> placed_points(const Scene& scene) {
  std::vector<PlacedPoint> points;
  for (const Joint& joint : scene.joints) add_joint(scene, joint, points);
  for (const Load& load : scene.loads) add_load(scene, load, points);
  for (const Body& body : scene.bodies) add_deflections(body, points);
  return points;
}

bool is_on_beam(const BeamBody& beam, double share, const Eigen::Vector3d& at,
                const Design<double>& design) {
  const double length = (position(beam.to, design) - position(beam.from, design)).stableNorm();
  return (at - point_at(beam, share, design)).stableNorm() <= placement_tolerance * length;
}

bool is_on_mass(const PointMass& mass, const Eigen::Vector3d& at, const Scene& scene,
                const Design<double>& design) {
  return (at - position(mass.at, design)).stableNorm() <=
         placement_tolerance * extent(scene, design);
}

}  // namespace pleuel
