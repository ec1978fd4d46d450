#pragma once

#include <vector>

#include "core/scene/body_constants.hpp"

namespace pleuel {

/// Coordinates of a body that is its own mirror image about a plane through the origin and moves in
/// it: those that move it as its mirror image does, (u, v) in the plane and the rotation about the
/// normal. Of a mode inertia tells: it couples with one kind only.
/// @param constants   of all coordinates
/// @param normal      0, 1 or 2: the x, y or z axis
/// @param prescribed  the first so many coordinates are of interfaces, six each; the rest are modes
std::vector<int> coordinates_in_plane(const BodyConstants& constants, int normal, int prescribed);

/// Takes out what couples such coordinates with motions across the plane: nothing but how little the
/// mesh is symmetric.
/// @returns the largest of it, relative to the numbers of its kind
double clear_across_plane(BodyConstants& constants, int normal);

}  // namespace pleuel
