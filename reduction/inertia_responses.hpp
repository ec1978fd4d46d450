#pragma once

#include "reduction/fixed_modes.hpp"

namespace pleuel {

/// Static deformations by the inertia of rigid accelerations, by the inertia of these deformations, and so on:
///     K r₁ = M r₀,   K r₂ = M r₁, …
/// made orthogonal one after the other (Gram–Schmidt), each with a mean square displacement of 1. They span a
/// Krylov space, which has what loads of slow accelerations do as well as modes have it (Wilson, Yuan & Dickens
/// 1982), and go continuously with the body, where modes change their order, and one leaves the lowest ones when
/// another enters. Scaled by displacements, and not by mass, they hardly change with a design at all.
///
/// @param rigid        r₀, a column each
/// @param generations  as many vectors as columns of r₀ each
/// @returns            squares are φᵀ K φ / φᵀ M φ: no frequencies, but above them
/// @throws InputError  if one has nothing that those before it have not
LowestModes inertia_responses(const StaticSolution& solve, const SolidMatrix& stiffness,
                              const SolidMatrix& mass, const Eigen::MatrixXd& rigid,
                              int generations);

}  // namespace pleuel
