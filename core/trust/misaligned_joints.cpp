#include "core/trust/misaligned_joints.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/base/eager_matrices.hpp"
#include "core/frame/body_frame.hpp"
#include "core/response/misalignment.hpp"

namespace pleuel {

namespace {

/// Nobody means less; more may be the breadth of a bearing.
constexpr double hardly_meant = 1e-3;
/// Of joints that lock a body altogether.
constexpr double locking = 3e-2;
/// [rad], or of the mechanism's size.
constexpr double idle_way = 1e-3;

struct BodyPose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
};

BodyPose pose_of(const std::string& body, const Model& model, const State& state) {
  if (body == ground_name) return {};
  const BodyFrame& frame = model.parts(body).front()->frame;
  const auto part = [&](const Eigen::VectorXd& of) {
    return of.segment(frame.offset, frame.size());
  };
  const FrameMotion<double> motion =
      frame_motion<double>(frame, part(state.q), part(state.v), part(state.a));
  return {motion.r, motion.A};
}

/// Of the second body of a joint as the first one sees it.
BodyPose relative_pose(const Joint& joint, const Model& model, const State& state) {
  const BodyPose first = pose_of(joint.bodies[0], model, state),
                 second = pose_of(joint.bodies[1], model, state);
  return {first.rotation.transpose() * (second.position - first.position),
          first.rotation.transpose() * second.rotation};
}

/// Whether the bodies of a joint move against each other.
bool moves(const Joint& joint, const TrustedRun& run) {
  const Trajectory& trajectory = run.analysis.trajectory;
  const Model& model = run.analysis.model;
  const double size = model.mechanism.scale.maxCoeff();
  State state;
  trajectory.states->load(0, state);
  const BodyPose start = relative_pose(joint, model, state);
  for (int step = 1; step <= trajectory.steps(); ++step) {
    trajectory.states->load(step, state);
    const BodyPose pose = relative_pose(joint, model, state);
    const double way = (pose.position - start.position).lpNorm<Eigen::Infinity>() / size;
    const double turn = (pose.rotation - start.rotation).lpNorm<Eigen::Infinity>();
    if (std::max(way, turn) > idle_way) return true;
  }
  return false;
}

/// Whether any of these joints does what it is there for.
bool any_moves(const std::vector<std::string>& names, const TrustedRun& run) {
  return std::any_of(run.problem.scene.joints.begin(), run.problem.scene.joints.end(),
                     [&](const Joint& joint) {
                       return std::find(names.begin(), names.end(), joint.name) != names.end() &&
                              moves(joint, run);
                     });
}

}  // namespace

std::vector<Finding> check_misaligned_joints(const TrustedRun& run) {
  State start;
  run.analysis.trajectory.states->load(0, start);
  const Model& model = run.analysis.model;
  std::vector<Finding> findings;
  for (const Misalignment& found : find_misalignments(model, start, locking)) {
    if (found.size > hardly_meant && any_moves(found.joints, run)) continue;
    findings.push_back({found.text(), true});
  }
  return findings;
}

}  // namespace pleuel
