#include "core/scene/scene_rules.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/scene/held_points.hpp"
#include "core/scene/reading/body_places.hpp"

namespace pleuel {

namespace {

/// Of the value at the start: so that differences may step across the limit of a range.
constexpr double range_tolerance = 1e-6;

bool has_bound_points(const Scene& scene) {
  bool has_bound = false;
  const auto look_at = [&](const Point& at, const PointKey&) {
    has_bound = has_bound || is_bound(at);
  };
  for (const Body& body : scene.bodies) {
    visit_body_points(body, look_at);
    const auto* imported = std::get_if<ImportedBody>(&body.shape);
    has_bound = has_bound || (imported != nullptr && !imported->variables.empty());
  }
  for (const Joint& joint : scene.joints) visit_held_places(joint, look_at);
  for (const Load& load : scene.loads) visit_held_places(load, look_at);
  return has_bound;
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

/// Changes of a variable, one of which tells any tolerance of places from rounding.
std::vector<double> changes_of(double value, double change) {
  constexpr double share = 1e-2;
  if (change != 0.0) return {change};
  return {share * value, share};
}

}  // namespace

std::optional<std::string> find_point_moved_along(const Scene& scene, const Design<double>& start,
                                                  std::size_t variable, double change) {
  PlacesOnBodies places(scene, start);
  for (const double by : changes_of(start[variable], change)) {
    Design<double> moved = start;
    moved[variable] += by;
    for (const PlacedPoint& placed : placed_points(scene)) {
      const bool is_on_elastic = placed.body != nullptr && is_elastic(*placed.body);
      if (!is_on_elastic || !places.find_misplaced(placed, moved, false)) continue;
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
  PlacesOnBodies places(scene, start);
  for (const PlacedPoint& placed : placed_points(scene)) {
    const auto found = places.find_misplaced(placed, design, true);
    if (!found) continue;
    return fmt::format("{} {}, is {}", placed.pointer(), found->rule, describe(found->at));
  }
  return std::nullopt;
}

}  // namespace pleuel
