#include "core/trust/joint_turns.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/find_named.hpp"
#include "core/model/scene_geometry.hpp"

namespace pleuel {

namespace {

/// The angle about a joint's axis by which the frame of its second body has turned against that of
/// the first since the start; that of deformation is left out. In (−π, π].
class JointAngle {
 public:
  JointAngle(const Model& model, const Joint& joint, const State& start)
      : first_(frame_of(model, joint.bodies[0])), second_(frame_of(model, joint.bodies[1])) {
    const Eigen::Vector3d axis = to_vector(joint.axis).normalized();
    const Eigen::Vector3d across = axis.unitOrthogonal();
    const Eigen::Matrix3d one = rotation(first_, start), other = rotation(second_, start);
    from_ = one.transpose() * across;
    beside_ = one.transpose() * axis.cross(across);
    turned_ = other.transpose() * across;
  }

  double at(const State& state) const {
    const Eigen::Matrix3d one = rotation(first_, state);
    const Eigen::Vector3d now = rotation(second_, state) * turned_;
    return std::atan2(now.dot(one * beside_), now.dot(one * from_));
  }

 private:
  static std::optional<BodyFrame> frame_of(const Model& model, const std::string& body) {
    if (body == ground_name) return std::nullopt;
    return model.parts(body).front()->frame;
  }

  static Eigen::Matrix3d rotation(const std::optional<BodyFrame>& frame, const State& state) {
    if (!frame) return Eigen::Matrix3d::Identity();
    const auto of = [&](const Eigen::VectorXd& all) {
      return Coordinates<double>(all.segment(frame->offset, frame->size()));
    };
    return frame_motion<double>(*frame, of(state.q), of(state.v), of(state.a)).A;
  }

  std::optional<BodyFrame> first_, second_;
  Eigen::Vector3d from_, beside_, turned_;
};

/// The first time at which the angle jumps from one end of its range to the other.
std::optional<double> jump_of(const TrustedRun& run, const Joint& joint) {
  const Trajectory& trajectory = run.analysis.trajectory;
  State state;
  trajectory.states->load(0, state);
  const JointAngle angle(run.analysis.model, joint, state);
  double before = 0.0;
  for (int step = 1; step <= trajectory.steps(); ++step) {
    trajectory.states->load(step, state);
    const double now = angle.at(state);
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
  const auto of_value = [&](const auto& point) -> std::optional<std::string> {
    if (!point.over || point.over->coordinate != DrivenCoordinate::angle) return std::nullopt;
    if (!jumps(point.value, design, end_time, 0.0)) return std::nullopt;
    return point.over->joint;
  };
  if (const auto* force = std::get_if<PointForce>(&load.element)) return of_value(*force);
  if (const auto* torque = std::get_if<PointTorque>(&load.element)) return of_value(*torque);
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
  return std::any_of(model.bodies.begin(), model.bodies.end(), [](const BodyModel& body) {
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

}  // namespace pleuel
