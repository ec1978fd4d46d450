#pragma once

#include <array>
#include <memory>
#include <string>

#include "core/response/buckling_signal.hpp"

namespace pleuel {

/// −N = −κ (bᵀd + ½ dᵀĜ d) [N] of each element of the stiffening of an imported body.
std::unique_ptr<Signal> make_line_compression_signal(const BodyModel& body,
                                                     const Eigen::Vector3d& gravity);

/// The compression of the line of stiffening, the same all along it, under which a body buckles whose
/// places A and B at both of its ends are held by pins:
///     K φ = P (Σ Ĝ − Uᵀ U/L) φ,   the smallest P > 0
/// with the displacement U of B against A across the line of length L. The second part turns the body
/// frame into the chord: slopes count against the line through A and B, whatever the
/// reference condition is, so that nothing else has to be held. Loads that coincide have the mean of
/// their derivatives.
/// @param chord  names of A and B
/// @throws InputError if these are not the ends of the stiffening
DesignFactor pinned_line_load(const BodyModel& body, const std::array<std::string, 2>& chord,
                              int variables);

}  // namespace pleuel
