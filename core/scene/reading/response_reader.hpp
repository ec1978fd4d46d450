#pragma once

#include "core/scene/problem_file.hpp"
#include "core/scene/reading/json_node.hpp"
#include "core/scene/reading/number_reader.hpp"

namespace pleuel {

/// @param simulation  whose end their windows of time keep to
/// @throws InputError
std::vector<ResponseSettings> read_responses(const JsonNode& node, const Scene& scene,
                                             const SimulationSettings& simulation,
                                             NumberReader& numbers);

}  // namespace pleuel
