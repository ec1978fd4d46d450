#pragma once

#include <vector>

#include "core/scene/problem_file.hpp"
#include "core/scene/reading/json_node.hpp"

namespace pleuel {

/// Responses whose bodies and joints are in the scene and can give them. @throws InputError
std::vector<ResponseSettings> read_responses(const JsonNode& node, const Scene& scene);

}  // namespace pleuel
