#include "core/model/rigid_motions.hpp"

#include <algorithm>
#include <array>

#include "core/base/dense_solvers.hpp"

namespace pleuel {

namespace {

constexpr double same_motion = 1e-4;
/// Joints that one search goes through; behind them everything may move.
constexpr int most_steps = 2000;

MotionSpace all_motions() {
  return MotionSpace::Identity(6, 6);
}

/// An orthonormal basis of what the columns span.
MotionSpace basis_of(MotionSpace motions) {
  if (motions.cols() == 0) return motions;
  motions.colwise().normalize();
  const PivotedQr qr(motions, same_motion);
  return qr.q().leftCols(qr.rank());
}

/// What is normal to all columns.
MotionSpace normal_to(const MotionSpace& motions) {
  if (motions.cols() == 0) return all_motions();
  return PivotedQr(motions, same_motion).normal_space();
}

MotionSpace sum(const MotionSpace& one, const MotionSpace& other) {
  MotionSpace both(6, one.cols() + other.cols());
  both << one, other;
  return basis_of(std::move(both));
}

MotionSpace common(const MotionSpace& one, const MotionSpace& other) {
  return normal_to(sum(normal_to(one), normal_to(other)));
}

bool is_driven(const Joint& joint, DrivenCoordinate coordinate) {
  return joint.drive && joint.drive->coordinate == coordinate;
}

bool is_point_mass(const Scene& scene, const std::string& name) {
  const Body* body = find_named(scene.bodies, name);
  return body != nullptr && std::holds_alternative<PointMass>(body->shape);
}

const std::string& other_body(const PlacedJoint& joint, const std::string& body) {
  return joint.bodies[joint.bodies[0] == body ? 1 : 0];
}

/// The motions of one side of a joint against the other.
class JointMotions {
 public:
  JointMotions(const PlacedJoint& joint, const Eigen::Vector3d& point, double length)
      : joint_(joint), arm_(point - joint.at), length_(length) {}

  MotionSpace find() {
    switch (joint_.type) {
      case JointType::fixed:
        break;
      case JointType::revolute:
        turn_about_axis();
        break;
      case JointType::prismatic:
        slide_along_axis();
        break;
      case JointType::cylindrical:
        turn_about_axis();
        slide_along_axis();
        break;
      case JointType::universal:
        turn_about_axis();
        turn_about(joint_.second_axis);
        break;
      case JointType::planar:
        turn_about_axis();
        slide_along(joint_.axis.unitOrthogonal());
        slide_along(joint_.axis.cross(joint_.axis.unitOrthogonal()));
        break;
      case JointType::spherical:
        turn_about_all();
        break;
      case JointType::point_on_line:
        turn_about_all();
        slide_along_axis();
        break;
      case JointType::distance:
        keep_distance();
        break;
    }
    if (joint_.has_point_mass) turn_about_all();
    return basis_of(std::move(left_));
  }

 private:
  void slide_along(const Eigen::Vector3d& axis) { add(axis, Eigen::Vector3d::Zero()); }
  void slide_along_axis() {
    if (!joint_.drives_displacement) slide_along(joint_.axis);
  }
  void turn_about(const Eigen::Vector3d& axis) { add(axis.cross(arm_) / length_, axis); }
  void turn_about_axis() {
    if (!joint_.drives_angle) turn_about(joint_.axis);
  }
  void turn_about_all() {
    for (int i = 0; i < 3; ++i) turn_about(Eigen::Vector3d::Unit(i));
  }

  /// All but those along the line between the points.
  void keep_distance() {
    const Eigen::Vector3d line = (joint_.to - joint_.at).normalized();
    MotionSpace held(6, 1);
    held << line, line.cross(arm_) / length_;
    left_ = normal_to(held);
  }

  void add(const Eigen::Vector3d& velocity, const Eigen::Vector3d& turn) {
    left_.conservativeResize(6, left_.cols() + 1);
    left_.col(left_.cols() - 1) << velocity, turn;
  }

  const PlacedJoint& joint_;
  Eigen::Vector3d arm_;
  double length_;
  MotionSpace left_ = MotionSpace(6, 0);
};

}  // namespace

/// From body to body, by joints to those that it has not come through.
class RigidMotions::Search {
 public:
  Search(const RigidMotions& motions, const Eigen::Vector3d& point, double length)
      : motions_(motions), point_(point), length_(length) {}

  MotionSpace left_by(const PlacedJoint& joint, const std::string& body) {
    path_.push_back(body);
    const MotionSpace left =
        sum(JointMotions(joint, point_, length_).find(), of_body(other_body(joint, body)));
    path_.pop_back();
    return left;
  }

 private:
  MotionSpace of_body(const std::string& body) {
    if (body == ground_name) return MotionSpace(6, 0);
    MotionSpace left = all_motions();
    for (const int index : motions_.joints_of(body)) {
      const PlacedJoint& joint = motions_.joint(index);
      const std::string& other = other_body(joint, body);
      if (std::find(path_.begin(), path_.end(), other) != path_.end()) continue;
      if (left.cols() == 0 || ++steps_ > most_steps) break;
      left = common(left, left_by(joint, body));
    }
    return left;
  }

  const RigidMotions& motions_;
  Eigen::Vector3d point_;
  double length_;
  std::vector<std::string> path_;
  int steps_ = 0;
};

RigidMotions::RigidMotions(const Scene& scene, const Design<double>& start) {
  for (const Joint& joint : scene.joints) {
    const bool is_distance = joint.type == JointType::distance;
    const Eigen::Vector3d at = resolve_point(joint.at, start);
    for (const std::string& body : joint.bodies) {
      of_body_[body].push_back(static_cast<int>(joints_.size()));
    }
    joints_.push_back(
        {joint.type, joint.bodies, at, is_distance ? resolve_point(joint.to, start) : at,
         to_vector(joint.axis).normalized(), to_vector(joint.second_axis).normalized(),
         is_driven(joint, DrivenCoordinate::angle),
         is_driven(joint, DrivenCoordinate::displacement),
         is_point_mass(scene, joint.bodies[0]) || is_point_mass(scene, joint.bodies[1])});
  }
}

const std::vector<int>& RigidMotions::joints_of(const std::string& body) const {
  static const std::vector<int> none;
  const auto found = of_body_.find(body);
  return found == of_body_.end() ? none : found->second;
}

MotionSpace RigidMotions::left_by(const PlacedJoint& joint, const std::string& body,
                                  const Eigen::Vector3d& point, double length) const {
  return Search(*this, point, length).left_by(joint, body);
}

}  // namespace pleuel
