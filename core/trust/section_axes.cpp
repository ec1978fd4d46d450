#include "core/trust/section_axes.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"

namespace pleuel {

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
  return std::all_of(body.beam.elements.begin(), body.beam.elements.end(), [](const auto& element) {
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

}  // namespace pleuel
