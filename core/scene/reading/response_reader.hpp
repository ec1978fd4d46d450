#pragma once

#include <vector>

#include "core/scene/reading/response_keys.hpp"

namespace pleuel {

/// Responses whose bodies and joints are in the scene and can give them. @throws InputError
std::vector<ResponseSettings> read_responses(const JsonNode& node, const ResponseContext& context);

}  // namespace pleuel
