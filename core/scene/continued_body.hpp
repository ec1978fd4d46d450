#pragma once

#include "core/scene/body_source.hpp"

namespace pleuel {

/// A body between the designs that it was made for: values and derivatives are those of the bodies there,
/// and what lies between is a mean of their Taylor expansions,
///     z(x) = Σ wⱼ (zⱼ + zⱼ′ (ξ − ξⱼ)),   wⱼ ∝ 1/|log x − log xⱼ|⁴,   Σ wⱼ = 1
/// (Shepard 1968; with derivatives Farwig 1986): the weights are flat at the designs. Of inertia,
/// stiffness and damping z is the logarithm (BodyChart), over ξ = log x where a variable is positive at
/// all designs: they stay positive for any step, and powers are continued exactly. Places and stress are
/// continued as they are, over ξ = x.
///
/// @param made_by  identity of the source that made them
/// @param designs  at least one, all with derivatives, the same variables and coordinates
std::shared_ptr<const BodySource> continue_body(
    const std::string& made_by, std::vector<std::shared_ptr<const InvariantsFile>> designs);

/// How differently two bodies are stiff: the largest |log μ| of K_a φ = μ K_b φ.
double stiffness_distance(const BodyConstants& a, const BodyConstants& b);

}  // namespace pleuel
