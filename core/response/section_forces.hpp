#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/model/model.hpp"
#include "core/response/station.hpp"
#include "core/section/section_stress.hpp"

namespace pleuel {

/// Those that normal stress and torsion are made from.
inline constexpr std::array section_force_parts = {
    SectionForcePart::axial, SectionForcePart::moment_y, SectionForcePart::moment_z,
    SectionForcePart::torque};
inline constexpr int section_force_count = section_force_parts.size();

/// @param numbers  in that order
template <class Scalar>
SectionForces<Scalar> section_forces(const Scalar* numbers) {
  return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

/// Section forces of the stations of a beam, a row of each station for each part: those of the strain
/// of the elements (N = EA Δu/ℓ, M = EI θ', T = GJ θx'), and what the inertia load w = −ρA a, linear in
/// the element, does between its nodes: without that, moments at nodes are off by wℓ²/12. Shear forces
/// are those of the part behind a section on the part before it, normal to the bent axis:
///     V_y = −dM_z/dx,   V_z = dM_y/dx
/// Where two elements of one segment meet, their section forces are averaged: of shear forces at a load
/// between them that is the mean of both sides.
Recovery section_recovery(const BodyModel& body, const std::vector<Station>& stations,
                          std::span<const SectionForcePart> parts);

/// Its derivative with respect to a design variable.
/// @param k  of the variable: in the order of BodyModel::beam_x
Recovery section_recovery_derivative(const BodyModel& body, const std::vector<Station>& stations,
                                     std::span<const SectionForcePart> parts, std::size_t k);

}  // namespace pleuel
