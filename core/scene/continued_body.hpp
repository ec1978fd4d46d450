#pragma once

#include "core/scene/body_source.hpp"

namespace pleuel {

/// A body between the designs that it was made for: values and derivatives are those of the bodies there,
/// and what lies between is a mean of Taylor polynomials (ExpansionMean). Of inertia, stiffness and
/// damping it is that of their logarithms (BodyChart), over log x where a variable is positive at all
/// designs: they stay positive for any step, and powers are continued exactly. Places and stress are
/// continued as they are, over x.
///
/// @param made_by  identity of the source that made them
/// @param designs  at least one, all with derivatives, the same variables and coordinates
std::shared_ptr<const BodySource> continue_body(
    const std::string& made_by, std::vector<std::shared_ptr<const InvariantsFile>> designs);

/// How differently two bodies are stiff: the largest |log μ| of K_a φ = μ K_b φ.
double stiffness_distance(const BodyConstants& a, const BodyConstants& b);

}  // namespace pleuel
