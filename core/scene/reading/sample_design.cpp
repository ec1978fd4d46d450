#include "core/scene/reading/sample_design.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/find_named.hpp"
#include "core/scene/held_points.hpp"
#include "core/scene/reading/geometry.hpp"
#include "core/scene/reading/mistakes.hpp"

namespace pleuel {

std::vector<SampleDesign> sample_designs(const std::vector<DesignVariable>& variables) {
  SampleDesign start;
  for (const DesignVariable& variable : variables) start.design.push_back(variable.start);
  std::vector<SampleDesign> samples = {start};
  for (std::size_t i = 0; i < variables.size(); ++i) {
    for (const auto& [bound, word] :
         {std::pair(variables[i].lower, "lower"), std::pair(variables[i].upper, "upper")}) {
      SampleDesign sample = start;
      sample.design[i] = bound;
      sample.where =
          fmt::format(", with the variable \"{}\" at its {} bound", variables[i].name, word);
      samples.push_back(sample);
    }
  }
  return samples;
}

namespace {

/// @param list  of the scene, in which the joint or load stands
template <class Holder>
void add_held(const Scene& scene, const char* list, const Holder& holder,
              std::vector<PlacedPoint>& points) {
  visit_held_points(holder, [&](const std::string& body, const Point& at, const PointKey& key) {
    std::vector<std::string> path = {list, holder.name, key.key};
    if (key.index >= 0) path.push_back(std::to_string(key.index));
    points.push_back({std::move(path), &at, find_named(scene.bodies, body)});
  });
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
  for (const Joint& joint : scene.joints) add_held(scene, "joints", joint, points);
  for (const Load& load : scene.loads) add_held(scene, "loads", load, points);
  for (const Body& body : scene.bodies) add_deflections(body, points);
  return points;
}

bool is_on_beam(const BeamBody& beam, double share, const Eigen::Vector3d& at,
                const Design<double>& design) {
  const double length =
      (resolve_point(beam.to, design) - resolve_point(beam.from, design)).stableNorm();
  return (at - point_at(beam, share, design)).stableNorm() <= placement_tolerance * length;
}

std::optional<std::string> find_off_place(const Body& body, const Point& at,
                                          const Design<double>& start,
                                          const Design<double>& design) {
  const auto& imported = std::get<ImportedBody>(body.shape);
  const BodyConstants& constants = imported.file->constants;
  const auto number = static_cast<std::size_t>(
      nearest_place(constants, local_point(imported, resolve_point(at, start), start)));
  const BodyPlace& place = constants.places[number];
  Eigen::Vector3d there = place.position;
  for (const ImportedVariable& of : imported.variables) {
    const ConstantsDerivative& derivative = imported.file->design[of.in_design];
    if (!derivative.derivative) continue;
    there += (resolve(of.number, design) - derivative.value) *
             derivative.derivative->places[number].position;
  }
  const Eigen::Vector3d local = local_point(imported, resolve_point(at, design), design);
  if ((local - there).stableNorm() <= placement_tolerance * size_of(constants)) return std::nullopt;
  return fmt::format(
      "must be at a place of the body \"{}\"; in its axes, the nearest one is \"{}\" at {} [m], "
      "got "
      "{}",
      body.name, place.name, describe(there), describe(local));
}

bool is_on_mass(const PointMass& mass, const Eigen::Vector3d& at, const Scene& scene,
                const Design<double>& design) {
  return (at - resolve_point(mass.at, design)).stableNorm() <=
         placement_tolerance * extent(scene, design);
}

}  // namespace pleuel
