#pragma once

#include "core/scene/reading/json_node.hpp"
#include "core/scene/scene.hpp"

namespace pleuel {

/// That walls fit into the outline. Only for the start: bounds that let walls and outlines cross
/// may have a linear constraint between them.
/// @param node  of the section. @throws InputError
void check_section(const JsonNode& node, const Section& section, const Design<double>& start);

}  // namespace pleuel
