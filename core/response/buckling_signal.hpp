#pragma once

#include <memory>
#include <vector>

#include "core/model/model.hpp"
#include "core/response/composed_signals.hpp"

namespace pleuel {

/// P_E [N] of a beam for bending in either plane, named ", bending along y"; one without a name where
/// they are equal.
std::vector<DesignFactor> euler_loads(const BodyModel& body, int variables);

/// −N [N] at every node and quarter point of the elements of a beam.
std::unique_ptr<Signal> make_compression_signal(const BodyModel& body,
                                                const Eigen::Vector3d& gravity);

/// Compressive axial force over the Euler load of the member as if pinned at both ends,
///     −N/P_E,   P_E = π² min(E I)/L²                                               [–]
/// 0.5 is a load factor of 2 against buckling. L is the length of the whole beam, E I the smallest
/// bending stiffness of its sections about an axis. The places of the compression come once for each
/// of the loads, one load after the other, whether the motion is in a plane or not. Where shear bends
/// the beam, P_E/(1 + P_E/(κGA)) takes the place of P_E (Engesser; Timoshenko & Gere, Theory of
/// Elastic Stability, art. 2.17).
/// That is safe for tapered members, and for members whose ends are held more firmly than by pins.
/// Where two sections have the same E I about an axis, the response has a kink.
/// @param compression  of the whole beam
/// @param loads        at least one
std::unique_ptr<Signal> make_buckling_signal(std::unique_ptr<Signal> compression,
                                             const std::vector<DesignFactor>& loads);

}  // namespace pleuel
