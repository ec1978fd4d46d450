#pragma once

#include "core/scene/body_constants.hpp"
#include "reduction/model_reader.hpp"

namespace pleuel {

/// The surface of a mesh as pictures show it: the corners of its faces with their displacement, in
/// triangles. Where it has more corners than asked for, those in one cell of a grid whose surfaces
/// face the same way become one: that which is nearest to their mean.
/// @param shape  displacements of all nodes per coordinate, 3 nodes × n
/// @param most   so many points at most
/// @throws InputError if a material has no modulus or Poisson ratio
BodySurface body_surface(const SolidMesh& mesh, const Eigen::MatrixXd& shape, int most);

}  // namespace pleuel
