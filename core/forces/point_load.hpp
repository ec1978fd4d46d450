#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/base/load_kind.hpp"
#include "core/base/time_law.hpp"
#include "core/forces/relative_kinematics.hpp"
#include "core/frame/marker.hpp"
#include "core/system/term.hpp"

namespace pleuel {

/// What the direction of a force or torque is attached to.
enum class LoadDirection {
  space,  ///< keeps its global direction
  body    ///< follows the marker: frame and elastic rotation
};

/// The numbers of a force or torque, which may depend on the design.
template <class Scalar>
struct PointLoadData {
  /// Of a force: undeformed, local axes [m].
  Vector3<Scalar> point = Vector3<Scalar>::Constant(Scalar(0));
  /// Unit vector: global axes for LoadDirection::space, local axes for LoadDirection::body.
  Vector3<Scalar> direction = Vector3<Scalar>::Constant(Scalar(0));
  TimeLaw<Scalar> value;  ///< [N] or [N m]

  template <class Function, class... Data>
  static void visit(Function&& function, Data&... data) {
    function(data.point...);
    function(data.direction...);
    function(data.value...);
  }
};

struct PointLoadTopology {
  std::string name;
  Marker marker;
  LoadKind kind = LoadKind::force;
  LoadDirection direction = LoadDirection::space;
};

/// A force f(t) d on a point of a body, or a torque: d fixed in space, or d = A R s, turning with the
/// marker, which has no potential. A torque does work on the rotation of the frame and on the elastic
/// rotation of the marker; a point mass does not notice.
/// @param derivatives  of the numbers with respect to the variables they depend on
std::unique_ptr<Term> make_point_load_term(
    PointLoadTopology topology, PointLoadData<double> data,
    std::vector<DesignDerivative<PointLoadData<double>>> derivatives);

/// The numbers of a force or torque that is a function of the coordinate of a joint; they may depend
/// on the design.
template <class Scalar>
struct LoadOverJointData {
  static Vector3<Scalar> zero() { return Vector3<Scalar>::Constant(Scalar(0)); }

  Vector3<Scalar> point = zero();  ///< of a force: undeformed, local axes [m]
  /// Unit vector: global axes for LoadDirection::space, local axes for LoadDirection::body.
  Vector3<Scalar> direction = zero();
  TimeLaw<Scalar> value;  ///< f(t, s, ṡ) [N] or [N m]
  // Of the joint, as of JointForceData:
  std::array<Vector3<Scalar>, 2> points = {zero(), zero()};
  std::array<Vector3<Scalar>, 3> directions = {zero(), zero(), zero()};
  Scalar offset = Scalar(0);

  template <class Function, class... Data>
  static void visit(Function&& function, Data&... data) {
    function(data.point...);
    function(data.direction...);
    function(data.value...);
    for (std::size_t m = 0; m < 2; ++m) function(data.points[m]...);
    for (std::size_t i = 0; i < 3; ++i) function(data.directions[i]...);
    function(data.offset...);
  }
};

struct LoadOverJointTopology {
  std::string name;
  std::array<Marker, 3> markers;  ///< where it acts, then those of the joint
  LoadKind kind = LoadKind::force;
  LoadDirection direction = LoadDirection::space;
  RelativeCoordinate coordinate = RelativeCoordinate::planar_angle;
  double sense = 1.0;  ///< of planar_angle
};

/// A force f(t, s, ṡ) d on a point of a body, or a torque, with s the coordinate of a joint: gas
/// force over the angle of a crank. Nothing acts back on the joint.
/// The term throws SimulationError, with name and time, where the angle has no value.
/// @param derivatives  of the numbers with respect to the variables they depend on
std::unique_ptr<Term> make_load_over_joint_term(
    LoadOverJointTopology topology, LoadOverJointData<double> data,
    std::vector<DesignDerivative<LoadOverJointData<double>>> derivatives);

}  // namespace pleuel
