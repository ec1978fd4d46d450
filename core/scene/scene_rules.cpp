#include "core/scene/scene_rules.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/scene/body_constants.hpp"
#include "core/scene/held_points.hpp"
#include "core/scene/reading/beam_places.hpp"
#include "core/scene/reading/geometry.hpp"
#include "core/scene/reading/mistakes.hpp"
#include "core/scene/reading/sample_design.hpp"

namespace pleuel {

namespace {

/// Of the value at the start: so that differences may step across the limit of a range.
constexpr double range_tolerance = 1e-6;

bool has_formula(const Point& point) {
  return std::ranges::any_of(point,
                             [](const Number& number) { return number.expression != nullptr; });
}

bool has_bound_points(const Scene& scene) {
  const auto of_body = [](const Body& body) {
    if (const auto* beam = std::get_if<BeamBody>(&body.shape)) {
      return is_bound(beam->from) || is_bound(beam->to);
    }
    if (const auto* imported = std::get_if<ImportedBody>(&body.shape)) {
      return is_bound(imported->from) || is_bound(imported->to) || !imported->variables.empty();
    }
    const auto* mass = std::get_if<PointMass>(&body.shape);
    return mass != nullptr && is_bound(mass->at);
  };
  const auto of_holder = [](const auto& holder) {
    bool has_bound = false;
    visit_held_points(holder, [&](const std::string&, const Point& at, const PointKey&) {
      has_bound = has_bound || is_bound(at);
    });
    return has_bound;
  };
  return std::ranges::any_of(scene.bodies, of_body) ||
         std::ranges::any_of(scene.joints, of_holder) ||
         std::ranges::any_of(scene.loads, of_holder);
}

std::optional<std::string> complaint(const RangedFormula& formula, const Design<double>& start,
                                     const Design<double>& design) {
  const double value = resolve(formula.number, design);
  if (is_within(formula.range, value)) return std::nullopt;
  const double tolerance = range_tolerance * std::abs(resolve(formula.number, start));
  const bool is_nearly =
      is_within(formula.range, value + tolerance) || is_within(formula.range, value - tolerance);
  if (is_nearly) return std::nullopt;
  return fmt::format("{} {}, is {:.6g}", formula.place, formula.rule, value);
}

std::optional<std::string> complaint(const PlacedPoint& placed, const BeamBody& beam,
                                     PlacesOfBeams& places, const Design<double>& design) {
  if (beam.is_rigid) return std::nullopt;
  // Whether it stays on the axis is known at both bounds of a plain variable, and so between them.
  const bool is_formula =
      has_formula(*placed.point) || has_formula(beam.from) || has_formula(beam.to);
  const BeamPlaces& of_beam = places.of(*placed.body);
  const auto found = is_formula ? of_beam.find_misplaced(*placed.point, design)
                                : of_beam.find_taken_along(*placed.point, design);
  if (!found) return std::nullopt;
  return fmt::format("{} {}, is {}", placed.pointer(), *found,
                     describe(resolve_point(*placed.point, design)));
}

std::optional<std::string> complaint(const PlacedPoint& placed, const PointMass& mass,
                                     const Scene& scene, const Design<double>& design) {
  if (!is_bound(*placed.point) && !is_bound(mass.at)) return std::nullopt;
  const Eigen::Vector3d at = resolve_point(*placed.point, design);
  if (is_on_mass(mass, at, scene, design)) return std::nullopt;
  return fmt::format("{} must be where the point mass \"{}\" is, {} [m], is {}", placed.pointer(),
                     placed.body->name, describe(resolve_point(mass.at, design)), describe(at));
}

/// Whether a place of an elastic body becomes another one of it that the model does not follow.
bool is_moved_along(const PlacedPoint& placed, PlacesOfBeams& places, const Design<double>& start,
                    std::size_t variable, double change) {
  const Point& point = *placed.point;
  if (const auto* beam = std::get_if<BeamBody>(&placed.body->shape)) {
    return !beam->is_rigid && places.of(*placed.body).leaves(point, variable, change);
  }
  if (const auto* imported = std::get_if<ImportedBody>(&placed.body->shape)) {
    Design<double> moved = start;
    moved[variable] += change;
    const Eigen::Vector3d before = local_point(*imported, resolve_point(point, start), start);
    const Eigen::Vector3d after = local_point(*imported, resolve_point(point, moved), moved);
    return (after - before).stableNorm() > placement_tolerance * size_of(imported->file->constants);
  }
  return false;
}

/// Changes of a variable, one of which tells any tolerance of places from rounding.
std::vector<double> changes_of(double value, double change) {
  constexpr double share = 1e-2;
  if (change != 0.0) return {change};
  return {share * value, share};
}

}  // namespace

std::optional<std::string> find_point_moved_along(const Scene& scene, const Design<double>& start,
                                                  std::size_t variable, double change) {
  PlacesOfBeams places(scene, start);
  for (const double by : changes_of(start[variable], change)) {
    for (const PlacedPoint& placed : placed_points(scene)) {
      if (placed.body == nullptr || !is_moved_along(placed, places, start, variable, by)) continue;
      return fmt::format(
          "moves {} along the elastic body \"{}\", or the body under it, where nothing follows it: "
          "what that changes is not known",
          placed.pointer(), placed.body->name);
    }
  }
  return std::nullopt;
}

std::optional<std::string> find_impossible(const Scene& scene, const Design<double>& start,
                                           const Design<double>& design) {
  for (const RangedFormula& formula : scene.formulas) {
    if (auto found = complaint(formula, start, design)) return found;
  }
  if (!has_bound_points(scene)) return std::nullopt;
  PlacesOfBeams places(scene, start);
  for (const PlacedPoint& placed : placed_points(scene)) {
    if (placed.body == nullptr) continue;
    std::optional<std::string> found;
    if (const auto* beam = std::get_if<BeamBody>(&placed.body->shape)) {
      found = complaint(placed, *beam, places, design);
    } else if (const auto* mass = std::get_if<PointMass>(&placed.body->shape)) {
      found = complaint(placed, *mass, scene, design);
    } else if (std::holds_alternative<ImportedBody>(placed.body->shape)) {
      found = find_off_place(*placed.body, *placed.point, start, design);
      if (found) found = placed.pointer() + " " + *found;
    }
    if (found) return found;
  }
  return std::nullopt;
}

}  // namespace pleuel
