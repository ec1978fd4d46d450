#pragma once

#include <optional>

#include "core/model/model.hpp"

namespace pleuel {

/// A state of a motion in a plane as one of the same mechanism in space, with consistent accelerations and multipliers: as
/// nothing couples motions in the plane with those out of it, a motion in the plane is one in space.
/// @param planar  whose state it is
/// @param space   the same bodies in space; coordinates that the plane does not have are zero
/// @returns nothing where deformations of the one are none of the other (a basis of the mean axis), or where the plane
///          leaves out what bears forces there (axial elasticity)
/// @throws SimulationError if joints of `space` do not allow it
std::optional<State> state_in_space(const Model& planar, const State& state, Model& space);

}  // namespace pleuel
