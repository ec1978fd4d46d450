#pragma once

#include "core/mechanism/mechanism.hpp"
#include "core/model/body_builder.hpp"
#include "core/model/build_context.hpp"

namespace pleuel {

/// Starts the elastic coordinates of a body with the deflections and rates that the scene gives it:
/// the shapes of least elastic energy in which the places move that far,
///     f(q) = Sᵀ μ,   S q = d   and   K v = Sᵀ ν,   S v = ḋ,
/// with a row of S for each place along its direction and d the displacements against the body frame;
/// and their derivatives. f are the elastic forces with geometric stiffening, so that no axial force
/// comes of bending; rates have the linear shape.
/// @param body    number of the body, in the scene and among the bodies
/// @param weight  of the softest of the given displacements in the assembly [1/m²]; those of the others
///                are as their stiffness
/// @param mechanism  whose guess of q, v and their derivatives is set
/// @throws InputError if a place cannot move along its direction, or if two say the same
void set_initial_deflections(std::size_t body, const std::vector<BodyModel>& bodies,
                             const BuildContext& context, double weight, Mechanism& mechanism);

}  // namespace pleuel
