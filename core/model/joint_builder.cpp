#include "core/model/joint_builder.hpp"

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/frame/number_data.hpp"
#include "core/joints/joint_term.hpp"
#include "core/scene/joint_kind.hpp"
#include "core/scene/visit_numbers.hpp"
#include "core/system/projected_term.hpp"

namespace pleuel {

namespace {

bool is_along(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::abs(a.dot(b)) > 0.5;  // of unit vectors that are parallel or normal
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
      : joint_(joint),
        kind_(kind_of(joint.type)),
        context_(context),
        sides_{Attachment(joint.bodies[0], joint.at, bodies, context),
               Attachment(joint.bodies[1], second_point(joint), bodies, context)} {}

  JointModel build(int coordinates, int first_multiplier) {
    model_.name = joint_.name;
    model_.first_multiplier = first_multiplier;
    JointTopology& topology = model_.topology;
    topology.name = joint_.name;
    topology.multiplier = coordinates + first_multiplier;
    topology.is_driven = joint_.drive.has_value();
    for (std::size_t m = 0; m < 2; ++m) topology.markers[m] = sides_[m].marker();
    if (context_.plane) {
      add_planar_equations(*context_.plane);
    } else {
      add_spatial_equations();
    }
    if (joint_.drive) model_.drive_row = first_multiplier + drive_equation_;
    model_.data = resolve_data(context_.design);
    differentiate();
    if (!sides_[0].is_direct() || !sides_[1].is_direct()) localise();
    return std::move(model_);
  }

 private:
  void localise() {
    CoordinateMap map = make_local(sides_, model_.topology.markers);
    model_.topology.multiplier = map.size();
    for (int i = 0; i < model_.equations(); ++i) {
      map.multipliers.push_back(model_.first_multiplier + i);
    }
    model_.map = std::move(map);
  }

  int add_direction(std::size_t marker, const Eigen::Vector3d& global) {
    directions_.push_back({marker, global});
    return int_size(directions_) - 1;
  }

  void add(const JointEquation& equation) { model_.topology.equations.push_back(equation); }

  void add_coincident(const Eigen::Vector3d& direction) {
    JointEquation equation{EquationKind::coincident};
    equation.fixed = direction;
    add(equation);
  }
  void add_point() {
    for (int i = 0; i < 3; ++i) add_coincident(Eigen::Vector3d::Unit(i));
  }
  void add_on_plane(const Eigen::Vector3d& normal) {
    JointEquation equation{EquationKind::on_plane};
    equation.first = add_direction(0, normal);
    add(equation);
  }
  void add_perpendicular(const Eigen::Vector3d& first, const Eigen::Vector3d& second) {
    if (!sides_[0].has_orientation() || !sides_[1].has_orientation())
      return;  // a point mass has no orientation
    JointEquation equation{EquationKind::perpendicular};
    equation.first = add_direction(0, first);
    equation.second = add_direction(1, second);
    add(equation);
  }
  /// The axis of the second body stays parallel to the normal of a and b.
  void add_parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    const Eigen::Vector3d n = a.cross(b);
    add_perpendicular(a, n);
    add_perpendicular(b, n);
  }
  /// @param axis  about which the angle counts, parallel to the normal
  void add_planar_angle(const Eigen::Vector3d& axis, const Eigen::Vector3d& normal) {
    if (!sides_[0].has_orientation() || !sides_[1].has_orientation()) return;
    JointEquation equation{EquationKind::planar_angle};
    equation.sense = axis.dot(normal) < 0.0 ? -1.0 : 1.0;
    add(equation);
  }
  void add_distance() { add(JointEquation{EquationKind::distance}); }

  /// The last equation is the drive's.
  void record_drive() {
    drive_equation_ = model_.equations() - 1;
    model_.topology.equations.back().is_driven = true;
  }
  void add_driven_slide(const Eigen::Vector3d& axis) {
    if (!is_driven(joint_, DrivenCoordinate::displacement)) return;
    JointEquation equation{EquationKind::slide};
    equation.first = add_direction(0, axis);
    add(equation);
    record_drive();
  }
  /// @param reference  turns about the axis with the second body
  void add_driven_angle(const Eigen::Vector3d& axis, const Eigen::Vector3d& reference) {
    if (!is_driven(joint_, DrivenCoordinate::angle)) return;
    JointEquation equation{EquationKind::drive};
    equation.first = add_direction(0, reference);
    equation.second = add_direction(1, reference);
    equation.third = add_direction(0, axis.cross(reference));
    add(equation);
    record_drive();
  }

  /// What is left of a joint in motion in a plane that it is symmetric about.
  void add_planar_equations(const MotionPlane& plane) {
    const Eigen::Vector3d axis = to_vector(joint_.axis).normalized();
    hold_planar_displacements(axis, plane);
    if (is_driven(joint_, DrivenCoordinate::angle)) {
      add_planar_angle(axis, plane.normal);
      record_drive();
    } else if (holds_planar_angle(axis, plane)) {
      add_planar_angle(plane.normal, plane.normal);
    }
    if (!is_driven(joint_, DrivenCoordinate::displacement)) return;
    if (kind_.has_length()) {
      record_drive();
    } else {
      add_driven_slide(axis);
    }
  }

  void hold_planar_displacements(const Eigen::Vector3d& axis, const MotionPlane& plane) {
    const bool is_normal = is_along(axis, plane.normal);
    switch (kind_.slides) {
      case JointSlides::none:
        add_planar_point(plane);
        break;
      case JointSlides::along_axis:
        if (is_normal) {
          add_planar_point(plane);
        } else {
          add_on_plane(plane.normal.cross(axis));
        }
        break;
      case JointSlides::across_axis:
        if (!is_normal) add_on_plane(axis);
        break;
      case JointSlides::at_distance:
        add_distance();
        break;
    }
  }

  void add_planar_point(const MotionPlane& plane) {
    add_coincident(plane.basis.col(0));
    add_coincident(plane.basis.col(1));
  }

  bool holds_planar_angle(const Eigen::Vector3d& axis, const MotionPlane& plane) const {
    const bool is_normal = is_along(axis, plane.normal);
    switch (kind_.turns) {
      case JointTurns::none:
        return true;
      case JointTurns::about_axis:
        return !is_normal;
      case JointTurns::about_both_axes:
        return !is_normal && !is_along(to_vector(joint_.second_axis).normalized(), plane.normal);
      default:
        return false;
    }
  }

  void add_spatial_equations() {
    const Eigen::Vector3d n = to_vector(joint_.axis).normalized();
    const Eigen::Vector3d a = reference_direction(sides_, n), b = n.cross(a);
    hold_displacements(n, a, b);
    if (kind_.has_length()) {
      if (joint_.drive) record_drive();
      return;
    }
    switch (kind_.turns) {
      case JointTurns::none:
        add_parallel(a, b);
        add_perpendicular(a, b);
        break;
      case JointTurns::about_axis:
        add_parallel(a, b);
        break;
      case JointTurns::about_both_axes:
        add_perpendicular(n, to_vector(joint_.second_axis).normalized());
        break;
      case JointTurns::all:
        break;
    }
    add_driven_angle(n, angle_reference(joint_, sides_));
    add_driven_slide(n);
  }

  /// @param n, a, b  axis of the joint, and two directions normal to it
  void hold_displacements(const Eigen::Vector3d& n, const Eigen::Vector3d& a,
                          const Eigen::Vector3d& b) {
    switch (kind_.slides) {
      case JointSlides::none:
        add_point();
        break;
      case JointSlides::along_axis:
        add_on_plane(a);
        add_on_plane(b);
        break;
      case JointSlides::across_axis:
        add_on_plane(n);
        break;
      case JointSlides::at_distance:
        add_distance();
        break;
    }
  }

  template <class Scalar>
  JointData<Scalar> resolve_data(const Design<Scalar>& design) const {
    JointData<Scalar> data;
    for (std::size_t m = 0; m < 2; ++m) data.points[m] = sides_[m].local_point(design);
    for (const AttachedDirection& direction : directions_) {
      data.directions.push_back(sides_[direction.marker].local_direction(direction.global, design));
    }
    if (context_.plane && sides_[0].has_orientation() && sides_[1].has_orientation()) {
      data.offset = sides_[1].start_angle(design) - sides_[0].start_angle(design);
    }
    if (kind_.has_length()) {
      data.length =
          Vector3<Scalar>(resolve_point(joint_.to, design) - resolve_point(joint_.at, design))
              .norm();
    }
    if (joint_.drive) data.drive = resolve_time_law(joint_.drive->motion, design, LawOf::motion);
    return data;
  }

  std::set<int> variables() const {
    std::set<int> all;
    for (const Attachment& side : sides_) side.add_variables(all);
    add_variables_of(joint_, all);
    return context_.differentiated(std::move(all));
  }

  void differentiate() {
    for (int variable : variables()) {
      const JointData<Dual> seeded = resolve_data(context_.seeded(variable));
      if (auto change = derivative_data(seeded)) {
        model_.derivatives.push_back({variable, std::move(*change)});
      }
    }
  }

  const Joint& joint_;
  const JointKind& kind_;
  const BuildContext& context_;
  std::array<Attachment, 2> sides_;
  std::vector<AttachedDirection> directions_;
  JointModel model_;
  int drive_equation_ = 0;
};

}  // namespace

JointModel make_joint(const Joint& joint, const std::vector<BodyModel>& bodies,
                      const BuildContext& context, int coordinates, int first_multiplier) {
  return JointBuilder(joint, bodies, context).build(coordinates, first_multiplier);
}

std::unique_ptr<Term> make_joint_term(const JointModel& joint, int coordinates) {
  auto term = make_joint_term(joint.topology, joint.data, joint.derivatives);
  if (!joint.map) return term;
  return std::make_unique<ProjectedTerm>(std::move(term), *joint.map, coordinates);
}

}  // namespace pleuel
