#pragma once

#include <memory>
#include <string>

#include "core/base/time_law.hpp"
#include "core/forces/load_direction.hpp"
#include "core/frame/marker.hpp"
#include "core/system/term.hpp"

namespace pleuel {

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

}  // namespace pleuel
