#pragma once

#include <vector>

#include "core/scene/reading/json_node.hpp"
#include "core/scene/reading/sample_design.hpp"

namespace pleuel {

/// Joints, loads and initial deflections are at points of their bodies: on the axis of an elastic beam, at the same
/// share of its length in all designs; where a point mass is; at a place of an imported body;
/// anywhere in the space of a rigid body. The two points of a distance or spring differ.
/// @param node     the scene in the document, to say where it is wrong.
/// @param samples  the start design first.
/// @throws InputError
void check_placement(const JsonNode& node, const Scene& scene,
                     const std::vector<SampleDesign>& samples);

}  // namespace pleuel
