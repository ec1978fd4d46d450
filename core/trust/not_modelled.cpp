#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/eager_matrices.hpp"
#include "core/model/body_frames.hpp"
#include "core/model/imported_constants.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/scene/body_source.hpp"
#include "core/scene/joint_kind.hpp"
#include "core/trust/check_list.hpp"

namespace pleuel {

namespace {

constexpr double harmless_kink = 1e-4;

/// The variables by which a body is not that of its file, with both values; empty if it is.
std::string moved_variables(const ImportedBody& imported, const ProblemFile& problem,
                            const Eigen::VectorXd& x) {
  const Design<double> design(x.begin(), x.end());
  std::vector<std::string> moved;
  for (const ImportedVariable& of : imported.variables) {
    const ConstantsDerivative& derivative = imported.file->design[of.in_design];
    if (derivative.derivative && is_zero(*derivative.derivative)) continue;
    const DesignVariable& variable = problem.variables[of.number.variable];
    const double size =
        derivative.value != 0.0 ? std::abs(derivative.value) : variable.upper - variable.lower;
    const double value = resolve(of.number, design);
    if (std::abs(value - derivative.value) <= harmless_kink * size) continue;
    moved.push_back(fmt::format("{} = {:.6g} instead of {:.6g} {}", derivative.variable, value,
                                derivative.value, derivative.unit));
  }
  return fmt::format("{}", fmt::join(moved, ", "));
}

}  // namespace

std::vector<Finding> check_extrapolation(const TrustedRun& run) {
  std::vector<Finding> findings;
  const Design<double> design(run.x.begin(), run.x.end());
  for (const Body& body : run.problem.scene.bodies) {
    const auto* imported = std::get_if<ImportedBody>(&body.shape);
    if (imported && imported->maker &&
        imported->maker->distance(body_values(*imported, design)) > 0.0) {
      findings.push_back(
          {fmt::format("the constants of \"{}\" are continued from other designs: {} "
                       "has not made it for this one",
                       body.name, imported->source),
           true});
    }
    if (!imported || !imported->is_linear) continue;
    const std::string moved = moved_variables(*imported, run.problem, run.x);
    if (moved.empty()) continue;
    findings.push_back(
        {fmt::format("the constants of \"{}\" are continued linearly to a design that its file {} "
                     "is not of: {}. Nothing says how wrong they are there. Write the file anew "
                     "for this design, go on from there, and repeat it until the design stays.",
                     body.name, imported->source, moved),
         true});
  }
  return findings;
}

namespace {

/// Of the length of a beam: no more than the distance to a node may be.
constexpr double short_way = 0.02;

/// Whether forces of a joint act on this body where the other one is.
bool has_contact(const Joint& joint, std::size_t side) {
  const JointKind& kind = kind_of(joint.type);
  const bool slides = kind.has_displacement() || kind.slides == JointSlides::across_axis;
  return slides && (side == 0 || kind.is_guide());
}

/// How far the other body's point of a joint goes along a beam, within its ends [m].
double way_along(const TrustedRun& run, const Joint& joint, std::size_t side, double length) {
  const Trajectory& trajectory = run.analysis.trajectory;
  const Design<double> design(run.x.begin(), run.x.end());
  const Eigen::Vector3d at = resolve_point(joint.at, design);
  const std::string &beam = joint.bodies[side], &slider = joint.bodies[1 - side];
  const FrameMotion<double> start =
      frame_motion(frame_of(run.analysis.model, slider), trajectory.state_at(0));
  const Eigen::Vector3d local = start.A.transpose() * (at - start.r);
  double least = length, most = 0.0;
  for (int step = 0; step <= trajectory.steps(); ++step) {
    const Pose<double> pose =
        relative_pose(run.analysis.model, beam, slider, trajectory.state_at(step));
    const double x = std::clamp((pose.origin + pose.rotation * local).x(), 0.0, length);
    least = std::min(least, x);
    most = std::max(most, x);
  }
  return most - least;
}

}  // namespace

std::vector<Finding> check_sliding_contacts(const TrustedRun& run) {
  std::vector<Finding> findings;
  for (const Joint& joint : run.problem.scene.joints) {
    for (std::size_t side = 0; side < 2; ++side) {
      const std::string& name = joint.bodies[side];
      if (name == ground_name || !has_contact(joint, side)) continue;
      const BodyModel& body = run.analysis.model.body(name);
      if (!body.is_beam() || !body.is_elastic) continue;
      const double length = body.beam.node_position(body.beam.node_count() - 1);
      const double way = way_along(run, joint, side, length);
      if (way <= short_way * length) continue;
      findings.push_back(
          {fmt::format("\"{}\" slides {:.3g} m along the elastic beam \"{}\", but the joint \"{}\" "
                       "belongs to the node where it is drawn: its forces act there, as by a rigid "
                       "lever, wherever the slider is. Loads that travel over an elastic beam are "
                       "not modelled. Do not trust these numbers; slide on a rigid body or on the "
                       "ground.",
                       joint.bodies[1 - side], way, name, joint.name),
           true});
    }
  }
  return findings;
}

}  // namespace pleuel
