#pragma once

#include "core/scene/problem_file.hpp"
#include "core/scene/reading/json_node.hpp"

namespace pleuel {

/// What only the scene as a whole can tell: the mechanism makes sense, beams have a length, walls
/// of tubes fit, joints and loads sit on their bodies. Where a design variable moves something,
/// this must hold at the start design and with each variable at either bound (walls of sections and
/// inertia tensors: at the start).
/// @param node  the scene in the document, to say where it is wrong.
/// @throws InputError
void check_scene(const JsonNode& node, const ProblemFile& problem);

}  // namespace pleuel
