#pragma once

#include "core/scene/reading/json_node.hpp"
#include "core/scene/scene.hpp"

namespace pleuel {

/// That walls fit into the outline (core/scene/body_rules.hpp), at the start. At other designs
/// build_model() looks.
/// @param node  of the section. @throws InputError
void check_section(const JsonNode& node, const Section& section, const Design<double>& start);

}  // namespace pleuel
