#pragma once

#include "core/scene/scene.hpp"

/// What the file of a body says of it.
namespace pleuel {

/// The body at a design: as it was read, continued, or made for it.
/// @returns                the derivatives of InvariantsFile::design are those at this design
/// @throws InputError      where the file holds for another design only
/// @throws SimulationError where it is no body any more, or cannot be made
std::shared_ptr<const InvariantsFile> body_at(const ImportedBody& imported, const Body& body,
                                              const Design<double>& design);

/// The values of its variables [SI].
Eigen::VectorXd body_values(const ImportedBody& imported, const Design<double>& design);

/// Index of the place that a point of the scene is at.
int place_at(const ImportedBody& imported, const Point& point, const Design<double>& start);

/// Whether the body moves in a plane through its origin without forces across it: neither inertia nor
/// places couple what is along the normal with what is in the plane. It may get thicker and thinner
/// (S_zz, H_zz), as a solid does by Poisson's effect.
/// @param normal  unit vector, in the axes of the body
bool is_symmetric(const BodyConstants& constants, const Eigen::Vector3d& normal);

}  // namespace pleuel
