#pragma once

#include "core/scene/scene.hpp"

/// What the file of a body says of it.
namespace pleuel {

/// The constants of the body, continued to a design.
/// @throws InputError      where the file holds for another design only
/// @throws SimulationError where it is no body any more
BodyConstants constants_at(const ImportedBody& imported, const Body& body,
                           const Design<double>& design);

/// Index of the place that a point of the scene is at.
int place_at(const ImportedBody& imported, const Point& point, const Design<double>& start);

/// Whether the body moves in a plane through its origin without forces across it.
/// @param normal  unit vector, in the axes of the body
bool is_symmetric(const BodyConstants& constants, const Eigen::Vector3d& normal);

}  // namespace pleuel
