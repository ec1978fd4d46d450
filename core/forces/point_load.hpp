#pragma once

#include <memory>
#include <string>

#include "core/base/time_law.hpp"
#include "core/frame/marker.hpp"
#include "core/system/term.hpp"

namespace pleuel {

/// What the direction of a force or torque is attached to.
enum class LoadDirection {
  space,  ///< keeps its global direction
  body    ///< follows the marker: frame and elastic rotation
};

/// The numbers of a point force, which may depend on the design.
template <class Scalar>
struct PointForceData {
  Vector3<Scalar> point = Vector3<Scalar>::Constant(Scalar(0));  ///< undeformed, local axes [m]
  /// Unit vector: global axes for LoadDirection::space, local axes for LoadDirection::body.
  Vector3<Scalar> direction = Vector3<Scalar>::Constant(Scalar(0));
  TimeLaw<Scalar> value;  ///< [N]

  template <class Function, class... Data>
  static void visit(Function&& function, Data&... data) {
    function(data.point...);
    function(data.direction...);
    function(data.value...);
  }
};

struct PointForceTopology {
  std::string name;
  Marker marker;
  LoadDirection direction = LoadDirection::space;
};

/// A force f(t) d on a point of a body: d fixed in space, or d = A R s, turning with the marker,
/// which has no potential.
/// @param derivatives  of the numbers with respect to the variables they depend on
std::unique_ptr<Term> make_point_force_term(
    PointForceTopology topology, PointForceData<double> data,
    std::vector<DesignDerivative<PointForceData<double>>> derivatives);

/// The numbers of a torque, which may depend on the design.
template <class Scalar>
struct PointTorqueData {
  /// Unit vector: global axes for LoadDirection::space, local axes for LoadDirection::body.
  Vector3<Scalar> direction = Vector3<Scalar>::Constant(Scalar(0));
  TimeLaw<Scalar> value;  ///< [N m]

  template <class Function, class... Data>
  static void visit(Function&& function, Data&... data) {
    function(data.direction...);
    function(data.value...);
  }
};

struct PointTorqueTopology {
  std::string name;
  Marker marker;
  LoadDirection direction = LoadDirection::space;
};

/// A torque m(t) d on a marker: d fixed in space, or d = A R s, turning with the marker. It does
/// work on the rotation of the frame and on the elastic rotation of the marker; a point mass does
/// not notice.
/// @param derivatives  of the numbers with respect to the variables they depend on
std::unique_ptr<Term> make_point_torque_term(
    PointTorqueTopology topology, PointTorqueData<double> data,
    std::vector<DesignDerivative<PointTorqueData<double>>> derivatives);

}  // namespace pleuel
