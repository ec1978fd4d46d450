#pragma once

#include <vector>

#include "core/model/model.hpp"
#include "core/response/station.hpp"
#include "core/section/section_stress.hpp"

namespace pleuel {

/// Section forces of a station of a beam: N, M_y, M_z, T.
inline constexpr int section_force_count = 4;

/// @param numbers  in that order
template <class Scalar>
SectionForces<Scalar> section_forces(const Scalar* numbers) {
  return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

/// Section forces of the stations of a beam, four rows each: those of the strain of the elements
/// (N = EA Δu/ℓ, M = EI θ', T = GJ θx'), and what the inertia load w = −ρA a, linear in the element,
/// does between its nodes: without that, moments at nodes are off by wℓ²/12. Where two elements of
/// one segment meet, their section forces are averaged.
Recovery section_force_recovery(const BodyModel& body, const std::vector<Station>& stations);

/// Its derivative with respect to a design variable.
/// @param k  of the variable: in the order of BodyModel::beam_x
Recovery section_force_derivative(const BodyModel& body, const std::vector<Station>& stations,
                                  std::size_t k);

/// Shear forces of the stations of a beam across it, along local y (1) or z (2), one row each, of the
/// part behind a section on the part before it, normal to the bent axis:
///     V_y = −dM_z/dx,   V_z = dM_y/dx
/// of the bending moments above, with what the inertia load does. Where two elements meet, their
/// shear forces are averaged: at a load between them that is the mean of both sides.
Recovery shear_force_recovery(const BodyModel& body, const std::vector<Station>& stations,
                              int direction);

/// Its derivative, as section_force_derivative().
Recovery shear_force_derivative(const BodyModel& body, const std::vector<Station>& stations,
                                int direction, std::size_t k);

/// What shears a section: V_y, V_z, T. Three rows a station.
inline constexpr int shearing_force_count = 3;
Recovery shearing_force_recovery(const BodyModel& body, const std::vector<Station>& stations);

/// Its derivative, as section_force_derivative().
Recovery shearing_force_derivative(const BodyModel& body, const std::vector<Station>& stations,
                                   std::size_t k);

}  // namespace pleuel
