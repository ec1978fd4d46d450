#pragma once

#include <filesystem>

#include "reduction/solid_mesh.hpp"

namespace pleuel {

/// Nodes, solid elements, sets of nodes and isotropic materials of an input file of CalculiX (or
/// Abaqus), with those that it includes. Other cards are passed over; names count without case.
/// Nodes that no solid element has are left out, as CalculiX does.
/// @throws InputError that names file and line.
SolidMesh read_calculix_input(const std::filesystem::path& path);

}  // namespace pleuel
