#pragma once

#include <vector>

#include "core/scene/problem_file.hpp"
#include "core/scene/reading/json_node.hpp"
#include "core/scene/reading/number_reader.hpp"

namespace pleuel {

/// What responses refer to, and who reads their times.
struct ResponseContext {
  const Scene& scene;
  const SimulationSettings& simulation;
  const NumberReader& numbers;
};

/// Responses whose bodies and joints are in the scene and can give them. @throws InputError
std::vector<ResponseSettings> read_responses(const JsonNode& node, const ResponseContext& context);

}  // namespace pleuel
