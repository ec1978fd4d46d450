#include "core/model/joint_holds.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "core/scene/joint_kind.hpp"

namespace pleuel {

namespace {

/// Motions that differ by less are the same.
constexpr double same_motion = 1e-4;
constexpr std::size_t most_bodies = 60;
/// What a turn counts beside a displacement where motions of the mechanism are taken off.
constexpr double turn_weight = 1e-3;

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// An orthonormal basis of what the columns span.
MotionSpace basis_of(MotionSpace motions) {
  if (motions.cols() == 0) return motions;
  motions.colwise().normalize();
  const PivotedQr qr(motions, same_motion);
  return qr.q().leftCols(qr.rank());
}

/// What is normal to all columns.
MotionSpace normal_to(const MotionSpace& motions) {
  if (motions.cols() == 0) return MotionSpace::Identity(6, 6);
  return PivotedQr(motions, same_motion).normal_space();
}

/// An orthonormal basis of {x : rows x = 0}.
Eigen::MatrixXd null_space(const Eigen::MatrixXd& rows) {
  if (rows.rows() == 0) return Eigen::MatrixXd::Identity(rows.cols(), rows.cols());
  return PivotedQr(rows.transpose(), same_motion).normal_space();
}

/// An orthonormal basis of what columns of at most unit size span.
MotionSpace space_of(const Eigen::MatrixXd& columns) {
  if (columns.cols() == 0 || columns.cwiseAbs().maxCoeff() < same_motion) return MotionSpace(6, 0);
  const PivotedQr qr(columns, same_motion);
  return qr.q().leftCols(qr.rank());
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
    const JointKind& kind = kind_of(joint_.type);
    if (kind.has_angle() && !joint_.drives_angle) turn_about(joint_.axis);
    if (kind.has_second_axis()) turn_about(joint_.second_axis);
    if (kind.turns == JointTurns::all || joint_.has_point_mass) turn_about_all();
    slide(kind.slides);
    return basis_of(std::move(left_));
  }

 private:
  void slide(JointSlides slides) {
    switch (slides) {
      case JointSlides::none:
        break;
      case JointSlides::along_axis:
        if (!joint_.drives_displacement) slide_along(joint_.axis);
        break;
      case JointSlides::across_axis:
        slide_across(joint_.axis);
        break;
      case JointSlides::at_distance:
        slide_across((joint_.to - joint_.at).normalized());
        break;
    }
  }
  void slide_along(const Eigen::Vector3d& axis) { add(axis, Eigen::Vector3d::Zero()); }
  void slide_across(const Eigen::Vector3d& axis) {
    const Eigen::Vector3d normal = axis.unitOrthogonal();
    slide_along(normal);
    slide_along(axis.cross(normal));
  }
  void turn_about(const Eigen::Vector3d& axis) { add(axis.cross(arm_) / length_, axis); }
  void turn_about_all() {
    for (int i = 0; i < 3; ++i) turn_about(Eigen::Vector3d::Unit(i));
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

/// The small motions of a beam's ends and of the bodies around it, and the equations of the joints
/// between them. Unknowns: (v/L, ω) of each body at the middle of the beam, then of the beam's
/// material at each of its joints.
class EndMotions {
 public:
  EndMotions(const RigidMotions& motions, const std::string& beam, const BeamAxis& axis,
             const std::vector<std::string>& bodies)
      : motions_(motions), beam_(beam), axis_(axis), own_(motions.joints_of(beam)) {
    for (const std::string& body : bodies) place_[body] = int_size(place_);
    first_end_ = 6 * std::ssize(bodies);
    size_ = first_end_ + 6 * std::ssize(own_);
    for (std::size_t j = 0; j < own_.size(); ++j) along_.push_back(j);
    const auto place_of = [&](std::size_t j) { return axis_.direction.dot(point(j)); };
    std::ranges::stable_sort(along_, [&](std::size_t one, std::size_t other) {
      return place_of(one) < place_of(other) - same_motion * axis_.length;
    });
  }

  /// 6 rows an end × motions.
  Eigen::MatrixXd find() {
    if (own_.empty()) return Eigen::MatrixXd(0, 0);
    add_joints_of_others();
    for (std::size_t j = 0; j < own_.size(); ++j) add_own_joint(j);
    keep_length();
    const Eigen::MatrixXd ends = null_space(rows_).bottomRows(size_ - first_end_);
    return without_motions_as_a_whole(ends);
  }

 private:
  const PlacedJoint& own(std::size_t j) const { return motions_.joint(own_[j]); }
  const Eigen::Vector3d& point(std::size_t j) const {
    return own(j).bodies[1] == beam_ ? own(j).to : own(j).at;
  }

  /// From the motion at the middle of the beam to that at a point.
  Matrix6 moved_to(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d arm = (point - axis_.middle) / axis_.length;
    Matrix6 moved = Matrix6::Identity();
    moved.topRightCorner<3, 3>() << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(),
        0;
    return moved;
  }

  MotionSpace held_by(const PlacedJoint& joint, const Eigen::Vector3d& point) const {
    return normal_to(JointMotions(joint, point, axis_.length).find());
  }

  Eigen::MatrixXd zero_rows(Eigen::Index count) const {
    return Eigen::MatrixXd::Zero(count, size_);
  }

  void add(const Eigen::MatrixXd& rows) {
    const Eigen::Index before = rows_.rows();
    rows_.conservativeResize(before + rows.rows(), size_);
    rows_.bottomRows(rows.rows()) = rows;
  }

  /// Of a body in the rows of a joint; the ground does not move.
  void set(const std::string& body, const Eigen::MatrixXd& of_body, Eigen::MatrixXd& rows) const {
    const auto found = place_.find(body);
    if (found != place_.end()) rows.middleCols(6 * found->second, 6) += of_body;
  }

  bool is_known(const std::string& body) const {
    return body == ground_name || place_.contains(body);
  }

  void add_joints_of_others() {
    for (const auto& [body, place] : place_) {
      for (const int index : motions_.joints_of(body)) {
        const PlacedJoint& joint = motions_.joint(index);
        const std::string& other = other_body(joint, body);
        const bool is_other_turn = place_.contains(other) && joint.bodies[0] != body;
        if (other == beam_ || !is_known(other) || is_other_turn) continue;
        const Eigen::MatrixXd held = held_by(joint, joint.at).transpose() * moved_to(joint.at);
        Eigen::MatrixXd rows = zero_rows(held.rows());
        set(body, held, rows);
        set(other, -held, rows);
        add(rows);
      }
    }
  }

  void add_own_joint(std::size_t j) {
    const std::string& other = other_body(own(j), beam_);
    if (!is_known(other)) return;
    const Eigen::MatrixXd held = held_by(own(j), point(j)).transpose();
    Eigen::MatrixXd rows = zero_rows(held.rows());
    rows.middleCols(first_end_ + 6 * static_cast<Eigen::Index>(j), 6) = held;
    set(other, -held * moved_to(point(j)), rows);
    add(rows);
  }

  void keep_length() {
    for (std::size_t j = 1; j < own_.size(); ++j) {
      Eigen::MatrixXd row = zero_rows(1);
      row.middleCols<3>(first_end_) = -axis_.direction.transpose();
      row.middleCols<3>(first_end_ + 6 * static_cast<Eigen::Index>(j)) =
          axis_.direction.transpose();
      add(row);
    }
  }

  Eigen::MatrixXd without_motions_as_a_whole(const Eigen::MatrixXd& ends) const {
    Eigen::MatrixXd straight(ends.rows(), 6);
    for (std::size_t j = 0; j < own_.size(); ++j) {
      straight.middleRows<6>(6 * static_cast<Eigen::Index>(j)) = moved_to(point(j));
    }
    Eigen::MatrixXd both(ends.rows(), ends.cols() + 6);
    both << ends, -straight;
    const Eigen::MatrixXd common = null_space(both).bottomRows<6>();
    return ends * null_space(anchors(straight * space_of(common)) * ends);
  }

  /// Rows of displacements and turns of ends, as many as there are columns, that tell motions as a
  /// whole from each other. Taken by ends and directions of motion: the global axes play no part.
  /// @param whole  motions of all ends
  Eigen::MatrixXd anchors(Eigen::MatrixXd whole) const {
    Eigen::MatrixXd rows(0, whole.rows());
    while (whole.cols() > 0) {
      const Eigen::Index first = largest_block(whole);
      const Eigen::MatrixXd block = whole.middleRows<3>(first);
      const PivotedQr qr(block, same_motion);
      const Eigen::Index before = rows.rows();
      rows.conservativeResize(before + qr.rank(), Eigen::NoChange);
      rows.bottomRows(qr.rank()).setZero();
      rows.bottomRows(qr.rank()).middleCols<3>(first) = qr.q().leftCols(qr.rank()).transpose();
      whole = whole * null_space(block);
    }
    return rows;
  }

  /// The first row of the displacement or turn of an end that is largest; of equal ones the first
  /// along the beam.
  Eigen::Index largest_block(const Eigen::MatrixXd& whole) const {
    constexpr double clearly = 1.0 + 1e-6;
    Eigen::Index largest = 0;
    double most = 0.0;
    for (const std::size_t j : along_) {
      const Eigen::Index first = 6 * static_cast<Eigen::Index>(j);
      for (const Eigen::Index row : {first, first + 3}) {
        const double size = whole.middleRows<3>(row).norm() * (row == first ? 1.0 : turn_weight);
        if (size > clearly * most) {
          most = size;
          largest = row;
        }
      }
    }
    return largest;
  }

  const RigidMotions& motions_;
  const std::string& beam_;
  const BeamAxis& axis_;
  const std::vector<int>& own_;
  std::vector<std::size_t> along_;  ///< numbers of its joints, in their order along the beam
  std::unordered_map<std::string, int> place_;
  Eigen::Index first_end_ = 0, size_ = 0;
  Eigen::MatrixXd rows_;
};

/// Of small motions of unit size: what has less than this share of them in a direction (as sin 6°)
/// counts as held in it.
constexpr double held_share = 0.1;

std::optional<HeldPlaces> held_places(const std::string& name, const BeamBody& beam,
                                      const Eigen::Matrix3d& axes) {
  if (!beam.held) return std::nullopt;
  const Eigen::Map<const Eigen::Vector3d> direction(beam.held->direction.data());
  const Eigen::Vector3d across = axes.transpose() * direction;
  HeldPlaces held{{}, beam.held->at};
  for (int i = 0; i < 3; ++i)
    held.displacements[i] = std::abs(across(i)) > 1.0 - held_share * held_share;
  if (held.displacements[1] || held.displacements[2]) return held;
  throw InputError(fmt::format(
      "/scene/bodies/{}/held/direction must be across the beam, along its local y or z", name));
}

}  // namespace

RigidMotions::RigidMotions(const Scene& scene, const Design<double>& start) {
  for (const Joint& joint : scene.joints) {
    const Eigen::Vector3d at = resolve_point(joint.at, start);
    for (const std::string& body : joint.bodies) {
      of_body_[body].push_back(int_size(joints_));
    }
    joints_.push_back(
        {joint.type, joint.bodies, at, resolve_point(second_point(joint), start),
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

/// Those that joints lead to, the nearest first.
std::vector<std::string> RigidMotions::bodies_around(const std::string& beam) const {
  std::vector<std::string> bodies;
  std::vector<std::string> reached = {beam};
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (const int index : joints_of(reached[i])) {
      const std::string& other = other_body(joints_[index], reached[i]);
      if (bodies.size() == most_bodies) return bodies;
      if (other == ground_name || std::ranges::find(reached, other) != reached.end()) continue;
      reached.push_back(other);
      bodies.push_back(other);
    }
  }
  return bodies;
}

std::vector<MotionSpace> RigidMotions::end_motions(const std::string& beam,
                                                   const BeamAxis& axis) const {
  const Eigen::MatrixXd ends = EndMotions(*this, beam, axis, bodies_around(beam)).find();
  std::vector<MotionSpace> spaces;
  for (Eigen::Index row = 0; row < ends.rows(); row += 6) {
    spaces.push_back(space_of(ends.middleRows<6>(row)));
  }
  return spaces;
}

JointHolds::JointHolds(const Scene& scene, const Design<double>& start) : motions_(scene, start) {
  for (const Body& body : scene.bodies) {
    const auto* beam = std::get_if<BeamBody>(&body.shape);
    if (beam == nullptr) continue;
    const Pose<double> pose = beam_pose(*beam, start);
    beams_[body.name] = {pose, (resolve_point(beam->to, start) - pose.origin).norm(),
                         held_places(body.name, *beam, pose.rotation)};
  }
}

const HeldPlaces* JointHolds::outside(const std::string& beam) const {
  const std::optional<HeldPlaces>& held = beams_.at(beam).held;
  return held ? &*held : nullptr;
}

std::vector<JointHold> JointHolds::of(const std::string& beam) const {
  const auto& [pose, length, held] = beams_.at(beam);
  const Eigen::Vector3d direction = pose.rotation.col(0);
  const std::vector<MotionSpace> motions =
      motions_.end_motions(beam, {pose.origin + 0.5 * length * direction, direction, length});
  std::vector<JointHold> holds;
  for (const int index : motions_.joints_of(beam)) {
    const PlacedJoint& joint = motions_.joint(index);
    const Eigen::Vector3d& point = joint.bodies[1] == beam ? joint.to : joint.at;
    const MotionSpace& left = motions[holds.size()];
    const auto is_held = [&](const Eigen::Vector3d& along, Eigen::Index first) {
      return (along.transpose() * left.middleRows(first, 3)).norm() <= held_share;
    };
    JointHold& hold = holds.emplace_back();
    hold.at = std::clamp((point - pose.origin).dot(direction) / length, 0.0, 1.0);
    for (int i = 0; i < 3; ++i) {
      hold.displacements[i] = is_held(pose.rotation.col(i), 0);
      hold.rotations[i] = is_held(pose.rotation.col(i), 3);
    }
  }
  return holds;
}

}  // namespace pleuel
