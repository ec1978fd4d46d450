#pragma once

#include <filesystem>

#include <Eigen/SparseCore>

#include "reduction/solid_mesh.hpp"

namespace pleuel {

using SolidMatrix = Eigen::SparseMatrix<double>;

/// K and M of a solid body, 3 nodes × 3 nodes, three displacements a node in the order of the mesh;
/// both triangles.
struct SolidMatrices {
  SolidMatrix stiffness, mass;
};

/// What CalculiX writes with *FREQUENCY, SOLVER=MATRIXSTORAGE: NAME.sti, NAME.mas and NAME.dof.
/// @param job  NAME, with its folder
/// @throws InputError that names file and line, also where the nodes are not those of the mesh.
SolidMatrices read_calculix_matrices(const std::filesystem::path& job, const SolidMesh& mesh);

/// Two files in the format Matrix Market (coordinate, real, general or symmetric).
/// @throws InputError that names file and line.
SolidMatrices read_market_matrices(const std::filesystem::path& stiffness,
                                   const std::filesystem::path& mass, const SolidMesh& mesh);

}  // namespace pleuel
