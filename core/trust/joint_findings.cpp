#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/find_named.hpp"
#include "core/mobility/lock.hpp"
#include "core/model/body_frames.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/response/monitors.hpp"
#include "core/start/degrees_of_freedom.hpp"
#include "core/trust/check_list.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

namespace {

/// Nobody means less; more may be the breadth of a bearing.
constexpr double hardly_meant = 1e-3;
/// Of joints that lock a body altogether.
constexpr double locking = 3e-2;
/// [rad], or of the mechanism's size.
constexpr double idle_way = 1e-3;

/// Whether the bodies of a joint move against each other.
bool moves(const Joint& joint, const TrustedRun& run) {
  const Trajectory& trajectory = run.analysis.trajectory;
  const double size = run.analysis.model.mechanism.scale.maxCoeff();
  const auto pose_at = [&](int step) {
    return relative_pose(run.analysis.model, joint.bodies[0], joint.bodies[1],
                         trajectory.state_at(step));
  };
  const Pose<double> start = pose_at(0);
  for (int step = 1; step <= trajectory.steps(); ++step) {
    const Pose<double> pose = pose_at(step);
    const double way = (pose.origin - start.origin).lpNorm<Eigen::Infinity>() / size;
    const double turn = (pose.rotation - start.rotation).lpNorm<Eigen::Infinity>();
    if (std::max(way, turn) > idle_way) return true;
  }
  return false;
}

/// Whether any of these joints does what it is there for.
bool any_moves(const std::vector<std::string>& names, const TrustedRun& run) {
  return std::ranges::any_of(run.problem.scene.joints, [&](const Joint& joint) {
    return std::ranges::find(names, joint.name) != names.end() && moves(joint, run);
  });
}

}  // namespace

std::vector<Finding> check_misaligned_joints(const TrustedRun& run) {
  const State start = run.analysis.trajectory.state_at(0);
  const Model& model = run.analysis.model;
  std::vector<Finding> findings;
  for (const Misalignment& found : find_misalignments(model, start, locking)) {
    if (found.size > hardly_meant && any_moves(found.joints, run)) continue;
    findings.push_back({found.text(), true});
  }
  return findings;
}

namespace {

/// The first time at which the angle of a joint jumps from one end of its range to the other. It is that
/// about its axis by which the frame of its second body has turned against that of the first since the
/// start, in (−π, π]; that of deformation is left out.
std::optional<double> jump_of(const TrustedRun& run, const Joint& joint) {
  const Model& model = run.analysis.model;
  const Trajectory& trajectory = run.analysis.trajectory;
  const auto turn_at = [&](const State& state) {
    return relative_pose(model, joint.bodies[0], joint.bodies[1], state).rotation;
  };
  const State start = trajectory.state_at(0);
  const Eigen::Matrix3d axes = frame_motion(frame_of(model, joint.bodies[0]), start).A;
  const Eigen::Vector3d axis = axes.transpose() * to_vector(joint.axis).normalized();
  const Eigen::Vector3d from = axis.unitOrthogonal(), beside = axis.cross(from);
  const Eigen::Vector3d turned = turn_at(start).transpose() * from;
  double before = 0.0;
  for (int step = 1; step <= trajectory.steps(); ++step) {
    const Eigen::Vector3d at = turn_at(trajectory.state_at(step)) * turned;
    const double now = std::atan2(at.dot(beside), at.dot(from));
    if (std::abs(now - before) > std::numbers::pi) return trajectory.time(step);
    before = now;
  }
  return std::nullopt;
}

/// Whether a law has another value after a whole turn.
bool jumps(const TimeFunction& function, const Design<double>& design, double end_time,
           double rest) {
  if (!depends_on_state(function)) return false;
  constexpr double pi = std::numbers::pi;
  constexpr int samples = 7;
  const TimeLaw<double> law = resolve_time_law(function, design);
  double difference = 0.0, size = 0.0;
  for (int i = 0; i < samples; ++i) {
    const double time = end_time * i / samples, rate = (i % 2 == 0 ? 1.0 : -1.0) * i;
    const double after = law.value_at(time, pi - rest, rate),
                 before = law.value_at(time, -pi - rest, rate);
    difference = std::max(difference, std::abs(after - before));
    size = std::max({size, std::abs(after), std::abs(before)});
  }
  return difference > 1e-9 * std::max(size, 1.0);
}

bool jumps(const JointForce& force, const Design<double>& design, double end_time) {
  const double rest = resolve(force.rest, design);
  return resolve(force.stiffness, design) != 0.0 || force.control ||
         (force.motor && jumps(*force.motor, design, end_time, 0.0)) ||
         (force.resistance && jumps(*force.resistance, design, end_time, rest));
}

/// The joint that a load counts the angle of, if what the load does jumps after half a turn.
std::optional<std::string> find_counted_joint(const Load& load, const Design<double>& design,
                                              double end_time) {
  if (const auto* point = std::get_if<PointLoad>(&load.element)) {
    if (!point->over || point->over->coordinate != DrivenCoordinate::angle) return std::nullopt;
    if (!jumps(point->value, design, end_time, 0.0)) return std::nullopt;
    return point->over->joint;
  }
  const auto* force = std::get_if<JointForce>(&load.element);
  if (!force || force->coordinate != DrivenCoordinate::angle) return std::nullopt;
  if (!jumps(*force, design, end_time)) return std::nullopt;
  return force->joint;
}

/// What its author calls it.
const char* kind_of(const JointForce& force) {
  if (force.motor || force.control) return "motor";
  return force.resistance ? "resistance" : "spring";
}

bool is_in_space(const Model& model) {
  return std::ranges::any_of(model.bodies, [](const BodyModel& body) {
    return body.frame.rotation == RotationCoordinates::rotation_vector;
  });
}

}  // namespace

std::vector<Finding> check_joint_turns(const TrustedRun& run) {
  if (!is_in_space(run.analysis.model)) return {};
  const Design<double> design(run.x.begin(), run.x.end());
  const Scene& scene = run.problem.scene;
  std::vector<Finding> findings;
  for (const Load& load : scene.loads) {
    const auto name = find_counted_joint(load, design, run.problem.simulation.end_time);
    if (!name) continue;
    const Joint* joint = find_named(scene.joints, *name);
    const std::optional<double> time = jump_of(run, *joint);
    if (!time) continue;
    const auto* in_joint = std::get_if<JointForce>(&load.element);
    findings.push_back(
        {fmt::format("the joint \"{}\" turns by more than half a turn, at t = {:.4g} s; in space "
                     "the {} \"{}\" counts its angle from -180 to 180 deg, and {} "
                     "jumps there. Only motion in a plane counts whole turns.",
                     joint->name, *time, in_joint ? kind_of(*in_joint) : "load", load.name,
                     in_joint ? "its moment" : "it"),
         true});
  }
  return findings;
}

std::string blocked_drives_text(const Model& model, const State& state) {
  const std::vector<int> drives = drive_rows(model);
  const int blocked = blocked_drives(model.mechanism, state, drives);
  if (blocked == 0) return "";
  const std::string what =
      drives.size() == 1
          ? fmt::format("the joints leave no motion to the drive of {}", names_of_drives(model))
          : fmt::format("there {} more than the joints leave motions to (drives: {})",
                        blocked == 1 ? "is one drive" : fmt::format("are {} drives", blocked),
                        names_of_drives(model));
  return what +
         ": what moves does so only because bodies bend. If that is not meant, a joint has a "
         "freedom "
         "too few (fixed instead of revolute, an axis in another direction, one joint too many), "
         "or "
         "a drive is too many";
}

std::vector<Finding> check_blocked_drives(const TrustedRun& run) {
  const State start = run.analysis.trajectory.state_at(0);
  const std::string text = blocked_drives_text(run.analysis.model, start);
  if (!text.empty()) return {{text}};
  if (run.analysis.rigid_path.end != RigidPath::End::bends) return {};
  return {{bending_text(run.analysis.model)}};
}

std::vector<Finding> check_rest(const TrustedRun& run) {
  const Model& model = run.analysis.model;
  const Mechanism& mechanism = model.mechanism;
  const RigidPath& path = run.analysis.rigid_path;
  const bool is_driven = drive_rows(model).empty() || path.time == 0.0 || path.travel > 0.0;
  if (is_driven || !model.terms.loads.empty() || !model.gravity.isZero(0.0) ||
      !mechanism.guess.v.isZero(0.0) || !mechanism.bent_starts.empty()) {
    return {};
  }
  return {
      {fmt::format("nothing moves: the drive of {} stands still, and no load, weight or initial "
                   "velocity acts. All numbers of the motion are round-off",
                   names_of_drives(model)),
       true}};
}

std::vector<Finding> check_undetermined_reactions(const TrustedRun& run) {
  if (std::ranges::none_of(run.analysis.model.effects, [](const EffectRecord& effect) {
        return effect.name == "redundant_constraints";
      })) {
    return {};
  }
  const Trajectory& trajectory = run.analysis.trajectory;
  const State state = trajectory.state_at(trajectory.steps() / 2);
  Finding finding;
  std::string names;
  for (std::size_t i = 0; i < run.problem.responses.size(); ++i) {
    const Response& response = run.analysis.responses[i];
    if (!response.history() || response.history()->signal->is_determined(state)) continue;
    finding.responses.push_back(response.name);
    names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", response.name);
  }
  if (names.empty()) return {};
  const bool is_one = finding.responses.size() == 1;
  finding.text = fmt::format(
      "{} {} not determined by the motion: joints hold more than they have to (`pleuel check` "
      "names "
      "them), and of all reactions that do so the smallest ones are shown. Real ones depend on how "
      "stiff each bearing is. Let joints hold what they do in the machine: of the two bearings of "
      "a "
      "shaft, for one, the first as \"spherical\", the second as \"point-on-line\".",
      names, is_one ? "is" : "are");
  return {finding};
}

}  // namespace pleuel
