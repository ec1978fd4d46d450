#pragma once

#include <string>
#include <vector>

#include "core/scene/body_constants.hpp"
#include "reduction/model_reader.hpp"

namespace pleuel {

/// @throws InputError where a rigid motion costs force (K r ≠ 0), or interfaces are not on one connected
///         part
void check_model(const ReductionModel& model);

/// What is possible, but hardly meant: mass against the mesh, density and stiffness against those of
/// materials, with the units that were understood.
std::vector<std::string> findings_about(const ReductionModel& model,
                                        const BodyConstants& constants);

/// The box around the nodes [m].
Eigen::Vector3d extent_of(const SolidMesh& mesh);

}  // namespace pleuel
