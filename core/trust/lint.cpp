#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/find_named.hpp"
#include "core/model/body_point.hpp"
#include "core/scene/held_points.hpp"
#include "core/scene/shown_unit.hpp"
#include "core/trust/check_list.hpp"

namespace pleuel {

namespace {

/// Ranges of some thousand times the start still lead to the same optimum; of 10⁷ times neither SLSQP nor
/// MMA nor Ipopt finds it (`optimize problems/four_bar.json --set /variables/coupler_height/upper=1e6`).
constexpr double far_times = 1e5;

bool is_far(double bound, double other, double start) {
  const double size = std::max(std::abs(start), std::abs(other));
  return start != 0.0 && std::abs(bound) > far_times * size;
}

Finding far_bound(const DesignVariable& variable, const char* side, double bound,
                  const ShownUnit& unit) {
  return {fmt::format(
      "the {} bound of variable \"{}\" is {:.3g}{}, {:.1g} times its start: steps and scales of a "
      "search come from the range between the bounds, which says nothing here, and an optimum may "
      "be missed. Is a unit missing? Else give a bound that the design may come near.",
      side, variable.name, unit.shown(bound), unit.suffix(), std::abs(bound / variable.start))};
}

}  // namespace

std::vector<Finding> check_far_bounds(const ProblemFile& problem) {
  std::vector<Finding> findings;
  const std::vector<ShownUnit> units = variable_units(problem);
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    const DesignVariable& variable = problem.variables[i];
    const auto see = [&](const char* side, double bound, double other) {
      if (!is_far(bound, other, variable.start)) return;
      findings.push_back(far_bound(variable, side, bound, units[i]));
    };
    see("lower", variable.lower, variable.upper);
    see("upper", variable.upper, variable.lower);
  }
  return findings;
}

namespace {

constexpr double far = 1e4;

/// The limit that a value exceeds or misses by far.
std::optional<double> far_limit(const ConstraintSettings& constraint, double value) {
  const double size = std::abs(value);
  if (constraint.upper && value > *constraint.upper && size > far * std::abs(*constraint.upper)) {
    return constraint.upper;
  }
  if (constraint.lower && value < *constraint.lower && far * size < std::abs(*constraint.lower)) {
    return constraint.lower;
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> far_limit_text(const ProblemFile& problem,
                                          const ConstraintSettings& constraint, double value) {
  if (constraint.response.empty() || !std::isfinite(value)) return std::nullopt;
  const std::optional<double> limit = far_limit(constraint, value);
  // A limit of zero is meant: any value is beyond it by far.
  if (!limit || *limit == 0.0 || value == 0.0) return std::nullopt;
  const std::string si = unit_of(problem, constraint).si, unit = si == "1" ? "" : " " + si;
  return fmt::format(
      "the limit of \"{}\" is {:.4g}{}, and the value {:.4g}{}: {:.1g} times as much. Is a unit "
      "missing, or another one meant?",
      constraint.name, *limit, unit, value, unit, std::abs(value / *limit));
}

std::vector<Finding> check_far_limits(const TrustedRun& run) {
  std::vector<Finding> findings;
  const Eigen::VectorXd values = values_of(run.analysis);
  for (const ConstraintSettings& constraint : run.problem.constraints) {
    const auto index = index_of_named(run.problem.responses, constraint.response);
    if (!index) continue;
    const auto text = far_limit_text(run.problem, constraint, values(*index));
    if (text) findings.push_back({*text, false, {constraint.response}});
  }
  return findings;
}

namespace {

/// Closer to z than this, small changes of the design turn the section far [rad].
constexpr double close = 0.02;
/// Moments of inertia that differ by less are the same.
constexpr double same_inertia = 1e-9;

Eigen::Vector3d direction_of(const BeamBody& beam, const Design<double>& design) {
  Eigen::Vector3d direction;
  for (int i = 0; i < 3; ++i)
    direction(i) = resolve(beam.to[i], design) - resolve(beam.from[i], design);
  return direction.normalized();
}

/// A variable that turns a beam; none if it stays where it is.
const DesignVariable* turning_variable(const TrustedRun& run, const BeamBody& beam) {
  const Design<double> design(run.x.begin(), run.x.end());
  const Eigen::Vector3d direction = direction_of(beam, design);
  for (std::size_t i = 0; i < design.size(); ++i) {
    const DesignVariable& variable = run.problem.variables[i];
    const double middle = 0.5 * (variable.lower + variable.upper);
    Design<double> other = design;
    other[i] +=
        1e-3 * (design[i] < middle ? variable.upper - design[i] : variable.lower - design[i]);
    if (direction_of(beam, other) != direction) return &variable;
  }
  return nullptr;
}

bool bends_alike(const BodyModel& body) {
  return std::ranges::all_of(body.beam.elements, [](const auto& element) {
    const auto& section = element.section;
    return std::abs(section.inertia_y - section.inertia_z) <= same_inertia * section.inertia_y;
  });
}

}  // namespace

std::vector<Finding> check_section_axes(const TrustedRun& run) {
  const Design<double> design(run.x.begin(), run.x.end());
  std::vector<Finding> findings;
  for (const Body& body : run.problem.scene.bodies) {
    const auto* beam = std::get_if<BeamBody>(&body.shape);
    if (!beam || beam->reference) continue;
    const double angle = direction_of(*beam, design).head<2>().norm();
    if (angle > close || bends_alike(*run.analysis.model.parts(body.name).front())) continue;
    const DesignVariable* variable = turning_variable(run, *beam);
    if (!variable) continue;
    findings.push_back(
        {fmt::format(
             "\"{0}\" is {1} the global z axis, and the variable \"{2}\" turns "
             "it: without a reference its section turns with it, local y being in the x-y "
             "plane, and by 90 deg where the beam is along z. Give \"{0}\" a \"reference\", "
             "a vector that local y is to follow, such as [0, 1, 0].",
             body.name, angle < 1e-9 ? "along" : fmt::format("{:.2g} rad from", angle),
             variable->name),
         true});
  }
  return findings;
}

namespace {

/// Of the length of the beam: less is the rounding of written numbers.
constexpr double rounding = 1e-6;

}  // namespace

std::vector<Finding> check_lost_places(const TrustedRun& run) {
  const Eigen::VectorXd x = start_design(run.problem);
  const Design<double> start(x.begin(), x.end());
  std::vector<Finding> findings;
  for (const Body& body : run.problem.scene.bodies) {
    const auto* beam = std::get_if<BeamBody>(&body.shape);
    if (beam == nullptr || beam->is_rigid) continue;
    const BodyModel& model = run.analysis.model.body(body.name);
    if (!model.is_elastic) continue;
    const double length = model.beam.node_position(model.beam.node_count() - 1);
    for (const AttachedPoint& point : attached_points(run.problem.scene, body.name)) {
      const BeamPlace place = held_place(model, share_along(*beam, point.at, start));
      if (place.is_node()) continue;
      const double distance = std::min(place.xi, 1.0 - place.xi) *
                              model.beam.elements[static_cast<std::size_t>(place.element)].length;
      if (distance <= rounding * length) continue;
      findings.push_back({fmt::format(
          "\"{}\" is only {:.2g} m beside an end of the beam \"{}\", a boundary of its segments or "
          "another place where something is: forces and stress in between are not known. Put both "
          "at one place, or give the beam shorter elements there.",
          point.name, distance, body.name)});
    }
  }
  return findings;
}

}  // namespace pleuel
