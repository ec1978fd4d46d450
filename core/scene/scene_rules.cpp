#include "core/scene/scene_rules.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/scene/body_constants.hpp"
#include "core/scene/held_points.hpp"
#include "core/scene/reading/geometry.hpp"
#include "core/scene/reading/limits.hpp"
#include "core/scene/reading/placed_points.hpp"

namespace pleuel {

namespace {

/// Of the value at the start: so that differences may step across the limit of a range.
constexpr double range_tolerance = 1e-6;

bool is_formula(const Point& point) {
  return std::any_of(point.begin(), point.end(),
                     [](const Number& number) { return number.expression != nullptr; });
}

bool has_point_formulas(const Scene& scene) {
  const auto of_body = [](const Body& body) {
    if (const auto* beam = std::get_if<BeamBody>(&body.shape)) {
      return is_formula(beam->from) || is_formula(beam->to);
    }
    const auto* mass = std::get_if<PointMass>(&body.shape);
    return mass != nullptr && is_formula(mass->at);
  };
  const auto of_holder = [](const auto& holder) {
    bool has_formula = false;
    visit_held_points(holder, [&](const std::string&, const Point& at, const PointKey&) {
      has_formula = has_formula || is_formula(at);
    });
    return has_formula;
  };
  return std::any_of(scene.bodies.begin(), scene.bodies.end(), of_body) ||
         std::any_of(scene.joints.begin(), scene.joints.end(), of_holder) ||
         std::any_of(scene.loads.begin(), scene.loads.end(), of_holder);
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
                                     const Design<double>& start, const Design<double>& design) {
  if (beam.is_rigid) return std::nullopt;
  if (!is_formula(*placed.point) && !is_formula(beam.from) && !is_formula(beam.to)) {
    return std::nullopt;
  }
  const double share = nearest_share(beam, position(*placed.point, start), start);
  const Eigen::Vector3d at = position(*placed.point, design);
  if (is_on_beam(beam, share, at, design)) return std::nullopt;
  return fmt::format(
      "{} must stay at the share {:.6g} of the length of the beam \"{}\", which is {} "
      "[m], is {}",
      placed.pointer(), share, placed.body->name, describe(point_at(beam, share, design)),
      describe(at));
}

std::optional<std::string> complaint(const PlacedPoint& placed, const PointMass& mass,
                                     const Scene& scene, const Design<double>& design) {
  if (!is_formula(*placed.point) && !is_formula(mass.at)) return std::nullopt;
  const Eigen::Vector3d at = position(*placed.point, design);
  if (is_on_mass(mass, at, scene, design)) return std::nullopt;
  return fmt::format("{} must be where the point mass \"{}\" is, {} [m], is {}", placed.pointer(),
                     placed.body->name, describe(position(mass.at, design)), describe(at));
}

/// Whether a place of an elastic body is another one of it at another design.
bool is_moved_along(const PlacedPoint& placed, const Design<double>& start,
                    const Design<double>& moved) {
  const Point& point = *placed.point;
  if (const auto* beam = std::get_if<BeamBody>(&placed.body->shape)) {
    if (beam->is_rigid) return false;
    const double share = nearest_share(*beam, position(point, start), start);
    return !is_on_beam(*beam, share, position(point, moved), moved);
  }
  if (const auto* imported = std::get_if<ImportedBody>(&placed.body->shape)) {
    const Eigen::Vector3d before = local_point(*imported, position(point, start), start);
    const Eigen::Vector3d after = local_point(*imported, position(point, moved), moved);
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
  for (const double by : changes_of(start[variable], change)) {
    Design<double> moved = start;
    moved[variable] += by;
    for (const PlacedPoint& placed : placed_points(scene)) {
      if (placed.body == nullptr || !is_moved_along(placed, start, moved)) continue;
      return fmt::format(
          "moves {} along the elastic body \"{}\", or the body under it, but a place of an elastic "
          "body stays what it is (of a beam its share of the length): what that changes is not "
          "known",
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
  if (!has_point_formulas(scene)) return std::nullopt;
  for (const PlacedPoint& placed : placed_points(scene)) {
    if (placed.body == nullptr) continue;
    std::optional<std::string> found;
    if (const auto* beam = std::get_if<BeamBody>(&placed.body->shape)) {
      found = complaint(placed, *beam, start, design);
    } else if (const auto* mass = std::get_if<PointMass>(&placed.body->shape)) {
      found = complaint(placed, *mass, scene, design);
    }
    if (found) return found;
  }
  return std::nullopt;
}

}  // namespace pleuel
