#pragma once

#include <vector>

#include "core/scene/problem_file.hpp"
#include "core/scene/reading/json_node.hpp"
#include "core/scene/reading/sample_design.hpp"
#include "core/scene/scene.hpp"

namespace pleuel {

/// What only the scene as a whole can tell: the mechanism makes sense, beams have a length, walls
/// of tubes fit, joints and loads sit on their bodies. Where a design variable moves something,
/// this must hold at the start design and with each variable at either bound (walls of sections and
/// inertia tensors: at the start).
/// @param node  the scene in the document, to say where it is wrong.
/// @throws InputError
void check_scene(const JsonNode& node, const ProblemFile& problem);

/// What needs no geometry of the design: a joint or a load acts on every body, what is driven or
/// loaded by an angle can turn, no motion is prescribed twice.
/// @param node  the scene in the document, to say where it is wrong.
/// @throws InputError
void check_mechanism(const JsonNode& node, const Scene& scene);

/// Joints, loads and initial deflections are at points of their bodies: on the axis of an elastic beam, at the same
/// share of its length in all designs; where a point mass is; at a place of an imported body;
/// anywhere in the space of a rigid body. The two points of a distance or spring differ.
/// @param node     the scene in the document, to say where it is wrong.
/// @param samples  the start design first.
/// @throws InputError
void check_placement(const JsonNode& node, const Scene& scene,
                     const std::vector<SampleDesign>& samples);

}  // namespace pleuel
