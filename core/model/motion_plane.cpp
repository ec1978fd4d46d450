#include "core/model/motion_plane.hpp"

#include <fmt/format.h>

namespace pleuel {

namespace {

constexpr double tolerance = 1e-9;

bool are_parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.cross(b).norm() <= tolerance * a.norm() * b.norm();
}
bool are_normal(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::abs(a.dot(b)) <= tolerance * a.norm() * b.norm();
}

/// A design variable may not move a point out of the plane.
bool is_bound_along(const Point& point, const Eigen::Vector3d& normal) {
  for (int i = 0; i < 3; ++i) {
    if (point[static_cast<std::size_t>(i)].is_bound() && std::abs(normal(i)) > tolerance) {
      return true;
    }
  }
  return false;
}

class PlaneCheck {
 public:
  PlaneCheck(const Scene& scene, const Design<double>& start, const Eigen::Vector3d& normal)
      : scene_(scene), start_(start), normal_(normal.normalized()) {}

  PlaneAnalysis run() {
    for (const Body& body : scene_.bodies) check_body(body);
    for (const Joint& joint : scene_.joints) check_joint(joint);
    const Eigen::Vector3d gravity = resolve_point(scene_.gravity, start_);
    require(gravity.isZero() || are_normal(gravity, normal_), "gravity");
    if (is_bound_along(scene_.gravity, normal_)) refuse("gravity");
    PlaneAnalysis analysis;
    if (!reason_.empty()) {
      analysis.reason = reason_ + " leaves the plane";
      return analysis;
    }
    MotionPlane plane;
    plane.normal = normal_;
    // e₁ = global x where that lies in the plane.
    Eigen::Vector3d e1 = Eigen::Vector3d::UnitX();
    if (std::abs(normal_.x()) > 0.9) e1 = Eigen::Vector3d::UnitY();
    e1 = (e1 - e1.dot(normal_) * normal_).normalized();
    plane.basis << e1, normal_.cross(e1);
    plane.point = point_.value_or(Eigen::Vector3d::Zero());
    analysis.plane = plane;
    analysis.reason =
        fmt::format("all of it is symmetric about the plane with normal ({:g}, {:g}, {:g})",
                    normal_.x(), normal_.y(), normal_.z());
    return analysis;
  }

 private:
  void refuse(const std::string& what) {
    if (reason_.empty()) reason_ = what;
  }
  void require(bool is_met, const std::string& what) {
    if (!is_met) refuse(what);
  }

  void check_point(const Point& point, const std::string& what) {
    const Eigen::Vector3d position = resolve_point(point, start_);
    if (!point_) point_ = position;
    const Eigen::Vector3d offset = position - *point_;
    require(std::abs(offset.dot(normal_)) <= tolerance * (offset.norm() + 1e-30), what);
    if (is_bound_along(point, normal_)) refuse(what);
  }

  void check_body(const Body& body) {
    const std::string what = "body " + body.name;
    if (const auto* beam = std::get_if<BeamBody>(&body.shape)) {
      check_point(beam->from, what);
      check_point(beam->to, what);
      const Pose<double> pose = beam_pose(*beam, start_);
      require(are_normal(pose.rotation.col(0), normal_), what);
      require(are_parallel(pose.rotation.col(1), normal_) ||
                  are_parallel(pose.rotation.col(2), normal_),
              "a principal axis of the sections of " + what);
    } else if (const auto* rigid = std::get_if<RigidBody>(&body.shape)) {
      check_point(rigid->at, what);
      check_inertia(*rigid, what);
    } else {
      check_point(std::get<PointMass>(body.shape).at, what);
    }
  }

  void check_inertia(const RigidBody& rigid, const std::string& what) {
    Eigen::Matrix<double, 6, 1> i;
    for (std::size_t k = 0; k < 6; ++k) i(static_cast<int>(k)) = resolve(rigid.inertia[k], start_);
    Eigen::Matrix3d inertia;
    inertia << i(0), i(3), i(4), i(3), i(1), i(5), i(4), i(5), i(2);
    const Eigen::Vector3d moment = inertia * normal_;
    require(moment.isZero() || are_parallel(moment, normal_),
            "a principal axis of inertia of " + what);
  }

  void check_joint(const Joint& joint) {
    const std::string what = "joint " + joint.name;
    check_point(joint.at, what);
    const Eigen::Vector3d axis = to_vector(joint.axis);
    if (joint.type == JointType::revolute) require(are_parallel(axis, normal_), what);
    const bool slides =
        joint.type == JointType::prismatic || joint.type == JointType::point_on_line;
    if (slides) require(are_normal(axis, normal_), what);
  }

  const Scene& scene_;
  const Design<double>& start_;
  Eigen::Vector3d normal_;
  std::optional<Eigen::Vector3d> point_;
  std::string reason_;
};

/// Axes of revolutes, or the cross product of two directions of the scene.
std::optional<Eigen::Vector3d> candidate_normal(const Scene& scene, const Design<double>& start) {
  std::vector<Eigen::Vector3d> directions;
  for (const Joint& joint : scene.joints) {
    if (joint.type == JointType::revolute) return to_vector(joint.axis);
    if (joint.type != JointType::fixed) directions.push_back(to_vector(joint.axis));
  }
  for (const Body& body : scene.bodies)
    directions.push_back(body_pose(body, start).rotation.col(0));
  for (const auto& direction : directions) {
    const Eigen::Vector3d normal = directions.front().cross(direction);
    if (normal.norm() > tolerance * direction.norm()) return normal;
  }
  return std::nullopt;
}

}  // namespace

PlaneAnalysis find_motion_plane(const Scene& scene, const Design<double>& start) {
  const auto normal = candidate_normal(scene, start);
  if (!normal) return {std::nullopt, "no direction of the scene determines a plane"};
  return PlaneCheck(scene, start, *normal).run();
}

}  // namespace pleuel
