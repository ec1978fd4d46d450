#pragma once

#include <memory>
#include <optional>

#include "core/model/model.hpp"
#include "core/response/signal.hpp"

namespace pleuel {

/// Von Mises stress [Pa] at the stress points of the sections at every node and quarter point of
/// the elements of a beam,
///     σ = N/A − M_z y/I_z + M_y z/I_y,   σ_vM = √(σ² + 3τ²),   τ = T/W
/// Section forces are those of the element (N from its strain, M = EI v″) plus the fixed-end terms
/// of the inertia load w = −ρA a, linear in the element: without them moments at nodes are off by
/// wℓ²/12. Where two elements of one segment meet, their section forces are averaged.
/// @param segment  only this segment
std::unique_ptr<Signal> make_stress_signal(const BodyModel& body, const Eigen::Vector3d& gravity,
                                           std::optional<int> segment);

}  // namespace pleuel
