#pragma once

#include "core/scene/body_constants.hpp"
#include "core/scene/reading/json_node.hpp"

namespace pleuel {

/// @param coordinates  of the body
/// @throws InputError
BodySurface read_surface(const JsonNode& node, int coordinates);

}  // namespace pleuel
