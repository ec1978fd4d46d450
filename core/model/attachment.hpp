#pragma once

#include <span>

#include "core/frame/marker.hpp"
#include "core/model/body_builder.hpp"
#include "core/model/body_point.hpp"
#include "core/system/projected_term.hpp"

namespace pleuel {

/// A point of the scene as a place on a body: where joints and loads hold on to it.
class Attachment {
 public:
  /// @param body  name of a body, or the ground
  /// @param to    the mean of the stretch of a body from `at` to here, in place of a point
  Attachment(const std::string& body, Point at, const std::vector<BodyModel>& bodies,
             const BuildContext& context, std::optional<Point> to = {});

  bool is_ground() const { return body_ == nullptr; }
  bool has_orientation() const { return model_ == nullptr || model_->frame.rotations() > 0; }
  /// Whether its displacements are coordinates themselves, so that a marker can name them.
  bool is_direct() const { return is_direct_; }
  const BodyModel* model() const { return model_; }
  /// Whether it lies as a beam; then its axes in global ones at t = 0 (of the start design).
  std::optional<Eigen::Matrix3d> beam_axes() const;

  /// Frame and elastic coordinates. Of a place that is not direct, elastic entries are set by
  /// make_local().
  Marker marker() const;

  /// The undeformed point in local axes [m].
  template <class Scalar>
  Vector3<Scalar> local_point(const Design<Scalar>& design) const {
    if (is_ground()) return resolve_point(at_, design);
    if (point_) return point_at(design);
    const Pose<Scalar> pose = body_pose(*body_, design);
    Vector3<Scalar> middle = resolve_point(at_, design);
    if (to_) middle = 0.5 * (middle + resolve_point(*to_, design));
    return pose.rotation.transpose() * (middle - pose.origin);
  }

  /// A direction that is given at t = 0 in global axes, in local axes.
  template <class Scalar>
  Vector3<Scalar> local_direction(const Eigen::Vector3d& global,
                                  const Design<Scalar>& design) const {
    const Vector3<Scalar> direction = global.template cast<Scalar>();
    if (is_ground()) return direction;
    return body_pose(*body_, design).rotation.transpose() * direction;
  }

  /// The angle of a frame in planar motion at t = 0; zero for the ground.
  template <class Scalar>
  Scalar start_angle(const Design<Scalar>& design) const {
    if (is_ground()) return Scalar(0);
    const auto q = frame_coordinates(model_->frame, body_pose(*body_, design));
    return q(q.size() - 1);
  }

  /// Adds the design variables that the place depends on.
  void add_variables(std::set<int>& variables) const;

  /// u v w θx θy θz of the place from generalized coordinates, and the derivatives of that.
  struct Rows {
    std::vector<int> coordinates;
    Eigen::MatrixXd values;  ///< 6 × coordinates
    std::vector<DesignDerivative<Eigen::MatrixXd>> derivatives;
  };
  const Rows& displacement_rows() const { return rows_; }

 private:
  void set_rows();
  bool are_coordinates() const;

  /// Exact to first order about the design of the model.
  template <class Scalar>
  Vector3<Scalar> point_at(const Design<Scalar>& design) const {
    Vector3<Scalar> point = point_->position.template cast<Scalar>();
    for (const auto& [variable, change] : point_->derivatives) {
      const Scalar distance = design[variable] - context_.design[variable];
      for (int k = 0; k < 3; ++k) point(k) += distance * change.position(k);
    }
    return point;
  }

  const BuildContext& context_;
  Point at_;
  std::optional<Point> to_;
  const Body* body_ = nullptr;
  const BodyModel* model_ = nullptr;
  std::optional<BodyPoint> point_;  ///< of elastic beams and of bodies from files
  Rows rows_{{}, Eigen::MatrixXd::Zero(6, 0), {}};
  bool is_direct_ = true;
};

/// A unit vector normal to the axis of a joint, from which its angle counts. Elastic rotations are
/// small, not zero, and angles depend on this choice to second order in them: it must turn with the
/// scene, hence comes from the axes of a beam.
/// @param axis  unit vector; this and the result in global axes at t = 0
Eigen::Vector3d reference_direction(std::span<const Attachment> attachments,
                                    const Eigen::Vector3d& axis);

/// The direction that the angle of a joint counts from: of a universal joint its second axis.
/// @param sides  of the joint
Eigen::Vector3d angle_reference(const Joint& joint, std::span<const Attachment> sides);

/// Gives the markers of some attachments local numbers, and the map from generalized to local
/// coordinates. Local multipliers follow the local coordinates.
CoordinateMap make_local(std::span<const Attachment> attachments, std::span<Marker> markers);

}  // namespace pleuel
