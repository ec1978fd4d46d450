#pragma once

#include "core/scene/reading/json_node.hpp"
#include "core/scene/scene.hpp"

namespace pleuel {

/// What needs no geometry of the design: a joint or a load acts on every body, what is driven or
/// loaded by an angle can turn, no motion is prescribed twice.
/// @param node  the scene in the document, to say where it is wrong.
/// @throws InputError
void check_mechanism(const JsonNode& node, const Scene& scene);

}  // namespace pleuel
