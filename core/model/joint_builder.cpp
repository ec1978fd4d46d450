#include "core/model/joint_builder.hpp"

#include <cassert>

#include "core/scene/visit_numbers.hpp"

namespace pleuel {

namespace {

/// One side of a joint.
struct Side {
  const Body* body = nullptr;  ///< null for the ground
  const BodyModel* model = nullptr;
  int node = 0;  ///< of a beam

  bool is_beam() const { return model != nullptr && model->is_beam(); }
  bool turns() const { return model == nullptr || model->frame.rotations() > 0; }
};

int nearest_node(const BodyModel& model, const BeamBody& beam, const Joint& joint,
                 const Design<double>& start) {
  const Eigen::Vector3d from = resolve_point(beam.from, start), to = resolve_point(beam.to, start);
  const double share =
      (resolve_point(joint.at, start) - from).dot(to - from) / (to - from).squaredNorm();
  const int last = model.beam.node_count() - 1;
  const double length = model.beam.node_position(last);
  int best = 0;
  for (int node = 1; node <= last; ++node) {
    const auto distance = [&](int n) {
      return std::abs(model.beam.node_position(n) / length - share);
    };
    if (distance(node) < distance(best)) best = node;
  }
  return best;
}

/// A direction of the joint, given at t = 0 in global axes, to be attached to one marker.
struct AttachedDirection {
  std::size_t marker;
  Eigen::Vector3d global;
};

class JointBuilder {
 public:
  JointBuilder(const Joint& joint, const std::vector<BodyModel>& bodies,
               const BuildContext& context)
      : joint_(joint), context_(context) {
    for (std::size_t m = 0; m < 2; ++m) find_side(joint.bodies[m], bodies, sides_[m]);
    for (Side& side : sides_) {
      if (side.is_beam()) {
        side.node =
            nearest_node(*side.model, std::get<BeamBody>(side.body->shape), joint, context.start);
      }
    }
  }

  JointParts build(int coordinates, int first_multiplier) {
    parts_.topology.name = joint_.name;
    parts_.topology.multiplier = coordinates + first_multiplier;
    parts_.topology.is_driven = joint_.drive.has_value();
    for (std::size_t m = 0; m < 2; ++m) parts_.topology.markers[m] = make_marker(sides_[m]);
    if (context_.plane) {
      add_planar_equations(*context_.plane);
    } else {
      add_spatial_equations();
    }
    parts_.model.name = joint_.name;
    if (joint_.drive) parts_.model.drive_row = first_multiplier + drive_equation_;
    parts_.data = resolve_data(context_.design);
    differentiate();
    return std::move(parts_);
  }

 private:
  void find_side(const std::string& name, const std::vector<BodyModel>& bodies, Side& side) {
    if (name == ground_name) return;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (bodies[i].name != name) continue;
      side.body = &context_.scene.bodies[i];
      side.model = &bodies[i];
    }
    assert(side.body != nullptr);
  }

  Marker make_marker(const Side& side) const {
    Marker marker;
    marker.frame = side.model ? side.model->frame : ground_frame();
    if (!side.is_beam()) return marker;
    for (int i = 0; i < 6; ++i) {
      marker.elastic[static_cast<std::size_t>(i)] = side.model->coordinate(side.node, i);
    }
    return marker;
  }

  int add_direction(std::size_t marker, const Eigen::Vector3d& global) {
    directions_.push_back({marker, global});
    return static_cast<int>(directions_.size()) - 1;
  }

  void add(const JointEquation& equation) { parts_.topology.equations.push_back(equation); }

  void add_coincident(const Eigen::Vector3d& direction) {
    JointEquation equation{EquationKind::coincident};
    equation.fixed = direction;
    add(equation);
  }
  void add_on_plane(const Eigen::Vector3d& normal) {
    JointEquation equation{EquationKind::on_plane};
    equation.first = add_direction(0, normal);
    add(equation);
  }
  void add_perpendicular(const Eigen::Vector3d& first, const Eigen::Vector3d& second) {
    if (!sides_[0].turns() || !sides_[1].turns()) return;  // a point mass has no orientation
    JointEquation equation{EquationKind::perpendicular};
    equation.first = add_direction(0, first);
    equation.second = add_direction(1, second);
    add(equation);
  }
  /// @param axis  about which the angle counts, parallel to the normal
  void add_planar_angle(const Eigen::Vector3d& axis, const Eigen::Vector3d& normal) {
    if (!sides_[0].turns() || !sides_[1].turns()) return;
    JointEquation equation{EquationKind::planar_angle};
    equation.sense = axis.dot(normal) < 0.0 ? -1.0 : 1.0;
    add(equation);
  }
  void note_drive() { drive_equation_ = static_cast<int>(parts_.topology.equations.size()) - 1; }

  void add_planar_equations(const MotionPlane& plane) {
    const Eigen::Vector3d axis = to_vector(joint_.axis).normalized();
    switch (joint_.type) {
      case JointType::revolute:
      case JointType::fixed:
        add_coincident(plane.basis.col(0));
        add_coincident(plane.basis.col(1));
        break;
      case JointType::prismatic:
      case JointType::point_on_line:
        add_on_plane(plane.normal.cross(axis));
        break;
    }
    const bool turns_freely =
        joint_.type == JointType::revolute || joint_.type == JointType::point_on_line;
    if (!turns_freely || joint_.drive) add_planar_angle(axis, plane.normal);
    if (joint_.drive) note_drive();
  }

  void add_spatial_equations() {
    const Eigen::Vector3d n = to_vector(joint_.axis).normalized();
    const Eigen::Vector3d a = n.unitOrthogonal(), b = n.cross(a);
    if (joint_.type == JointType::revolute || joint_.type == JointType::fixed) {
      for (int i = 0; i < 3; ++i) add_coincident(Eigen::Vector3d::Unit(i));
    } else {
      add_on_plane(a);
      add_on_plane(b);
    }
    if (joint_.type == JointType::point_on_line) return;
    add_perpendicular(a, n);
    add_perpendicular(b, n);
    if (joint_.type != JointType::revolute) add_perpendicular(a, b);
    if (!joint_.drive) return;
    JointEquation equation{EquationKind::drive};
    equation.first = add_direction(0, a);
    equation.second = add_direction(1, a);
    equation.third = add_direction(0, b);
    add(equation);
    note_drive();
  }

  template <class Scalar>
  Vector3<Scalar> local_point(const Side& side, const Design<Scalar>& design) const {
    if (side.body == nullptr) return resolve_point(joint_.at, design);
    if (side.is_beam()) {
      const auto beam = resolve_beam(std::get<BeamBody>(side.body->shape), context_.scene, design);
      return {beam.node_position(side.node), Scalar(0), Scalar(0)};
    }
    const Pose<Scalar> pose = body_pose(*side.body, design);
    return pose.rotation.transpose() * (resolve_point(joint_.at, design) - pose.origin);
  }

  template <class Scalar>
  Scalar planar_angle(const Side& side, const Design<Scalar>& design) const {
    if (side.body == nullptr) return Scalar(0);
    const auto q = frame_coordinates(side.model->frame, body_pose(*side.body, design));
    return q(q.size() - 1);
  }

  template <class Scalar>
  JointData<Scalar> resolve_data(const Design<Scalar>& design) const {
    JointData<Scalar> data;
    for (std::size_t m = 0; m < 2; ++m) data.points[m] = local_point(sides_[m], design);
    for (const AttachedDirection& direction : directions_) {
      const Side& side = sides_[direction.marker];
      const Vector3<Scalar> global = direction.global.template cast<Scalar>();
      data.directions.push_back(
          side.body ? Vector3<Scalar>(body_pose(*side.body, design).rotation.transpose() * global)
                    : global);
    }
    const bool both_turn = sides_[0].turns() && sides_[1].turns();
    if (context_.plane && both_turn) {
      data.offset = planar_angle(sides_[1], design) - planar_angle(sides_[0], design);
    }
    if (!joint_.drive) return data;
    data.drive = resolve_time_law(joint_.drive->motion, design);
    return data;
  }

  std::set<int> variables() const {
    std::set<int> all;
    for (const Side& side : sides_) {
      if (side.body) all.merge(variables_of(*side.body, context_.scene));
    }
    visit_numbers(joint_, [&](const Number& number, const Quantity&) {
      if (number.is_bound()) all.insert(number.variable);
    });
    return all;
  }

  void differentiate() {
    for (int variable : variables()) {
      const JointData<Dual> seeded = resolve_data(context_.seeded(variable));
      JointData<double> derivative;
      bool is_zero = true;
      const auto part = [&](const Dual& number) {
        is_zero = is_zero && derivative_of(number) == 0.0;
        return derivative_of(number);
      };
      for (std::size_t m = 0; m < 2; ++m) derivative.points[m] = seeded.points[m].unaryExpr(part);
      for (const auto& direction : seeded.directions) {
        derivative.directions.emplace_back(direction.unaryExpr(part));
      }
      derivative.offset = part(seeded.offset);
      derivative.drive = seeded.drive.transformed<double>(part);
      if (!is_zero) parts_.derivatives.push_back({variable, std::move(derivative)});
    }
  }

  const Joint& joint_;
  const BuildContext& context_;
  std::array<Side, 2> sides_;
  std::vector<AttachedDirection> directions_;
  JointParts parts_;
  int drive_equation_ = 0;
};

}  // namespace

JointParts make_joint(const Joint& joint, const std::vector<BodyModel>& bodies,
                      const BuildContext& context, int coordinates, int first_multiplier) {
  return JointBuilder(joint, bodies, context).build(coordinates, first_multiplier);
}

}  // namespace pleuel
