#pragma once

#include <memory>

#include "core/model/model.hpp"
#include "core/response/signal.hpp"
#include "core/response/station.hpp"

namespace pleuel {

/// The points of a round outline in space at which a stress is taken.
enum class OutlinePoints {
  most_stressed,  ///< they move with the load: the largest and the smallest stress at each instant
  fixed  ///< 24 that stay where they are, as those of other sections: for averages and cycles over time
};

/// Stress [Pa] at the stress points of the sections of an elastic beam. With
///     σ = N/A − M_z y/I_z + M_y z/I_y,    τ = shear · T
///     von_mises    √(σ² + 3τ²)
///     normal       σ, signed (pull is positive)
///     axial        N/A
///     bending      σ without N/A, signed
///     shear        τ, signed as the torque
///     utilization  √(σ² + 3τ²) over the strength of the material [–]
/// Of the most stressed points of a round outline in space, normal and bending stress have their
/// maximum on the half where bending pulls and their minimum on the other one.
/// @param points  only round outlines in space make a difference between both kinds
std::unique_ptr<Signal> make_stress_signal(const BodyModel& body, const Eigen::Vector3d& gravity,
                                           StressPart part, OutlinePoints points,
                                           const StationChoice& stations);

/// Points of a section with stresses of their own. In planar motion, points that differ only across
/// the plane see the same stress, and those in the middle of others see less than them.
std::vector<int> distinct_stress_points(const BodyModel& body,
                                        const SectionProperties<double>& section);

/// Shear stress [Pa] of shear forces and torsion at the places of the sections of an elastic beam
/// where it can be the largest (ShearPoint), its magnitude. Of motion in a plane the place that the
/// shear force of this plane makes the largest.
/// @pre all sections have such places
std::unique_ptr<Signal> make_shear_stress_signal(const BodyModel& body,
                                                 const Eigen::Vector3d& gravity,
                                                 const StationChoice& stations);

}  // namespace pleuel
