#include "core/model/motion_plane.hpp"

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/model/imported_constants.hpp"
#include "core/scene/held_points.hpp"
#include "core/scene/joint_kind.hpp"

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
    if (point[i].is_bound() && std::abs(normal(i)) > tolerance) {
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
    for (const Load& load : scene_.loads) check_load(load);
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
    check_velocity(body);
    check_deflections(body);
    visit_body_points(body, [&](const Point& at, const PointKey&) { check_point(at, what); });
    if (const auto* beam = std::get_if<BeamBody>(&body.shape)) {
      const Pose<double> pose = beam_pose(*beam, start_);
      require(are_normal(pose.rotation.col(0), normal_), what);
      require(are_parallel(pose.rotation.col(1), normal_) ||
                  are_parallel(pose.rotation.col(2), normal_),
              "a principal axis of the sections of " + what);
    } else if (const auto* rigid = std::get_if<RigidBody>(&body.shape)) {
      check_inertia(*rigid, what);
    } else if (const auto* imported = std::get_if<ImportedBody>(&body.shape)) {
      const Eigen::Vector3d local = beam_pose(*imported, start_).rotation.transpose() * normal_;
      require(is_symmetric(imported->file->constants, local), what);
    }
  }

  void check_deflections(const Body& body) {
    const std::string what = "an initial deflection of body " + body.name;
    for (const InitialDeflection& one : body.initial_deflections) {
      check_point(one.at, what);
      require(are_normal(to_vector(one.direction), normal_), what);
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
    const bool is_normal_axis = are_parallel(axis, normal_);
    const bool is_axis_in_plane = are_normal(axis, normal_);
    const bool turns = is_driven(joint, DrivenCoordinate::angle);
    const JointKind& kind = kind_of(joint.type);
    if (kind.has_axis()) {
      const bool may_be_normal = kind.has_angle() || kind.slides == JointSlides::across_axis,
                 may_lie_in_plane = !kind.only_turns_about_axis();
      require((may_be_normal && is_normal_axis) || (may_lie_in_plane && is_axis_in_plane), what);
    }
    if (kind.has_second_axis()) {
      const Eigen::Vector3d second = to_vector(joint.second_axis);
      require(are_parallel(second, normal_) || are_normal(second, normal_), what);
    }
    if (kind.has_length()) check_point(joint.to, what);
    if (!joint.drive || kind.has_length()) return;
    require(turns ? is_normal_axis : is_axis_in_plane, "the drive of " + what);
  }

  void check_load(const Load& load) {
    const std::string what = "load " + load.name;
    visit_held_points(
        load, [&](const std::string&, const Point& at, const PointKey&) { check_point(at, what); });
    if (const auto* point = std::get_if<PointLoad>(&load.element)) {
      const Eigen::Vector3d direction = to_vector(point->direction);
      require(point->is_force() ? are_normal(direction, normal_) : are_parallel(direction, normal_),
              what);
      if (point->over) check_coordinate(point->over->joint, point->over->coordinate, what);
    } else if (const auto* of_joint = std::get_if<JointForce>(&load.element)) {
      check_coordinate(of_joint->joint, of_joint->coordinate, what);
    }
  }

  void check_coordinate(const std::string& name, DrivenCoordinate coordinate,
                        const std::string& what) {
    for (const Joint& joint : scene_.joints) {
      if (joint.name != name) continue;
      const Eigen::Vector3d axis = to_vector(joint.axis);
      const bool turns = coordinate == DrivenCoordinate::angle;
      require(turns ? are_parallel(axis, normal_) : are_normal(axis, normal_), what);
    }
  }

  void check_velocity(const Body& body) {
    const Eigen::Vector3d velocity = resolve_point(body.velocity, start_);
    const Eigen::Vector3d spin = resolve_point(body.angular_velocity, start_);
    require(are_normal(velocity, normal_) && !is_bound_along(body.velocity, normal_),
            "the velocity of body " + body.name);
    bool is_in_plane = spin.isZero() || are_parallel(spin, normal_);
    for (int i = 0; i < 3; ++i) {
      const bool is_bound = body.angular_velocity[i].is_bound();
      if (is_bound && std::abs(std::abs(normal_(i)) - 1.0) > tolerance) is_in_plane = false;
    }
    require(is_in_plane, "the angular velocity of body " + body.name);
  }

  const Scene& scene_;
  const Design<double>& start_;
  Eigen::Vector3d normal_;
  std::optional<Eigen::Vector3d> point_;
  std::string reason_;
};

/// Directions that a plane of motion can be normal to: axes of joints that turn, and cross products
/// of the directions and distances of the scene, of its loads and of initial deflections.
std::vector<Eigen::Vector3d> candidate_normals(const Scene& scene, const Design<double>& start) {
  std::vector<Eigen::Vector3d> normals, directions, points;
  for (const Joint& joint : scene.joints) {
    const Eigen::Vector3d axis = to_vector(joint.axis);
    const JointKind& kind = kind_of(joint.type);
    if (kind.only_turns_about_axis()) return {axis};
    if (kind.has_axis()) directions.push_back(axis);
    if (kind.has_second_axis()) directions.push_back(to_vector(joint.second_axis));
    points.push_back(resolve_point(joint.at, start));
    if (kind.has_length()) points.push_back(resolve_point(joint.to, start));
  }
  for (const Body& body : scene.bodies) {
    const Pose<double> pose = body_pose(body, start);
    points.push_back(pose.origin);
    const bool lies_as_beam = std::holds_alternative<BeamBody>(body.shape) ||
                              std::holds_alternative<ImportedBody>(body.shape);
    if (lies_as_beam) directions.push_back(pose.rotation.col(0));
    for (const InitialDeflection& one : body.initial_deflections) {
      directions.push_back(to_vector(one.direction));
    }
  }
  for (const auto& point : points) {
    const Eigen::Vector3d distance = point - points.front();
    if (!distance.isZero(tolerance)) directions.push_back(distance);
  }
  const Eigen::Vector3d gravity = resolve_point(scene.gravity, start);
  if (!gravity.isZero()) directions.push_back(gravity);
  for (const Load& load : scene.loads) {
    if (const auto* point = std::get_if<PointLoad>(&load.element)) {
      directions.push_back(to_vector(point->direction));
    }
  }
  normals = directions;  // an axis may itself be the normal
  for (const auto& direction : directions) {
    const Eigen::Vector3d normal = directions.front().cross(direction);
    if (normal.norm() <= tolerance * directions.front().norm() * direction.norm()) continue;
    normals.insert(normals.begin(), normal);
    break;
  }
  return normals;
}

}  // namespace

PlaneAnalysis find_motion_plane(const Scene& scene, const Design<double>& start) {
  std::optional<PlaneAnalysis> first;
  for (const Eigen::Vector3d& normal : candidate_normals(scene, start)) {
    PlaneAnalysis analysis = PlaneCheck(scene, start, normal).run();
    if (analysis.plane) return analysis;
    if (!first) first = std::move(analysis);
  }
  return first.value_or(
      PlaneAnalysis{std::nullopt, "no direction of the scene determines a plane"});
}

PlaneAnalysis decide_motion_plane(const Scene& scene, EffectChoice spatial,
                                  const Design<double>& start) {
  if (spatial == EffectChoice::on) return {std::nullopt, "asked for"};
  PlaneAnalysis analysis = find_motion_plane(scene, start);
  if (spatial == EffectChoice::off && !analysis.plane) {
    throw InputError("/effects/spatial_motion is \"off\", but " + analysis.reason);
  }
  return analysis;
}

}  // namespace pleuel
