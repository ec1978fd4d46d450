#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/base/time_law.hpp"
#include "core/forces/force_term.hpp"
#include "core/forces/relative_kinematics.hpp"
#include "core/frame/marker.hpp"

namespace pleuel {

/// The numbers of a joint force, which may depend on the design.
template <class Scalar>
struct JointForceData {
  static Vector3<Scalar> zero() { return Vector3<Scalar>::Constant(Scalar(0)); }

  /// Of `displacement`: undeformed, local axes of each body [m].
  std::array<Vector3<Scalar>, 2> points = {zero(), zero()};
  /// Unit vectors, local axes of the body they belong to. `angle`: d_a and d_b on the first, d' on
  /// the second marker; `displacement`: d on the first marker.
  std::array<Vector3<Scalar>, 3> directions = {zero(), zero(), zero()};
  Scalar offset = Scalar(0);        ///< of `planar_angle` [rad]
  Scalar stiffness = Scalar(0);     ///< k [N m/rad] or [N/m]
  Scalar damping = Scalar(0);       ///< c [N m s/rad] or [N s/m]
  Scalar rest = Scalar(0);          ///< s₀ [rad] or [m]
  TimeLaw<Scalar> motor;            ///< m(t, s, ṡ) [N m] or [N]; none without parameters
  TimeLaw<Scalar> resistance = {};  ///< r(s − s₀, ṡ, t) [N m] or [N]; none without parameters
  // Of a motor that follows a motion s*(t):
  TimeLaw<Scalar> target;           ///< s* [rad] or [m]; none without parameters
  Scalar proportional = Scalar(0);  ///< [N m/rad] or [N/m]
  Scalar derivative = Scalar(0);    ///< [N m s/rad] or [N s/m]

  template <class Function, class... Data>
  static void visit(Function&& function, Data&... data) {
    for (std::size_t m = 0; m < 2; ++m) function(data.points[m]...);
    for (std::size_t i = 0; i < 3; ++i) function(data.directions[i]...);
    function(data.offset...);
    function(data.stiffness...);
    function(data.damping...);
    function(data.rest...);
    function(data.motor...);
    function(data.resistance...);
    function(data.target...);
    function(data.proportional...);
    function(data.derivative...);
  }
};

struct JointForceTopology {
  std::string name;
  std::array<Marker, 2> markers;
  RelativeCoordinate coordinate = RelativeCoordinate::planar_angle;
  double sense = 1.0;  ///< of planar_angle: −1 if the joint's axis is opposite to the normal
};

/// Spring, viscous friction, resistance and motor in a joint:
///     τ = −k (s − s₀) − c ṡ − r(s − s₀, ṡ, t) + M,
///     M = m(t, s, ṡ) + proportional (s* − s) + derivative (ṡ* − ṡ)
/// on the second body, the opposite on the first.
/// Its gauge reads s, ṡ, −k (s − s₀) − c ṡ − r, the power M ṡ of the motor, and what the damper and
/// the resistance to a rate take.
/// Both throw SimulationError, with name and time, where the angle has no value.
/// @param derivatives  of the numbers with respect to the variables they depend on
ForceElement make_joint_force(
    const JointForceTopology& topology, const JointForceData<double>& data,
    const std::vector<DesignDerivative<JointForceData<double>>>& derivatives);

/// Reads a joint in which nothing acts.
std::unique_ptr<Gauge> make_joint_gauge(
    const JointForceTopology& topology, const JointForceData<double>& data,
    const std::vector<DesignDerivative<JointForceData<double>>>& derivatives);

}  // namespace pleuel
