#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/base/time_law.hpp"
#include "core/forces/force_term.hpp"
#include "core/frame/marker.hpp"

namespace pleuel {

/// The numbers of a spring-damper, which may depend on the design.
template <class Scalar>
struct SpringDamperData {
  /// Undeformed, local axes of each body [m].
  std::array<Vector3<Scalar>, 2> points = {Vector3<Scalar>::Constant(Scalar(0)),
                                           Vector3<Scalar>::Constant(Scalar(0))};
  Scalar stiffness = Scalar(0);     ///< k [N/m]
  Scalar damping = Scalar(0);       ///< c [N s/m]
  Scalar free_length = Scalar(0);   ///< l₀ [m]
  TimeLaw<Scalar> resistance = {};  ///< r(l − l₀, l̇, t) [N]; none without parameters

  template <class Function, class... Data>
  static void visit(Function&& function, Data&... data) {
    for (std::size_t m = 0; m < 2; ++m) function(data.points[m]...);
    function(data.stiffness...);
    function(data.damping...);
    function(data.free_length...);
    function(data.resistance...);
  }
};

struct SpringDamperTopology {
  std::string name;
  std::array<Marker, 2> markers;
};

/// Pulls its two points together with k (l − l₀) + c l̇ + r. Its gauge reads l, l̇, this pull and
/// the power that the damper takes.
/// Both throw SimulationError, with name and time, where the two points coincide and it would pull.
/// @param derivatives  of the numbers with respect to the variables they depend on
ForceElement make_spring_damper(
    const SpringDamperTopology& topology, const SpringDamperData<double>& data,
    const std::vector<DesignDerivative<SpringDamperData<double>>>& derivatives);

/// What a damper and the resistance to a rate take: c ṡ + r(e, ṡ, t) − r(e, 0, t).
template <class Scalar>
Scalar damper_force(const Scalar& damping, const TimeLaw<Scalar>& resistance, double time,
                    const Scalar& elongation, const Scalar& rate) {
  return damping * rate + resistance.value_at(time, elongation, rate) -
         resistance.value_at(time, elongation, Scalar(0));
}

}  // namespace pleuel
