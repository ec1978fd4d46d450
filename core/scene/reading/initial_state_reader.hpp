#pragma once

#include "core/scene/problem_file.hpp"
#include "core/scene/reading/json_node.hpp"
#include "core/scene/reading/number_reader.hpp"

namespace pleuel {

/// How the simulation starts: "consistent", "quasi-static" or "periodic", or one of these as the
/// "type" of an object, with the "period" of a periodic one.
/// @param settings  with the times and the formulation
void read_initial_state(const JsonNode& node, const NumberReader& numbers,
                        SimulationSettings& settings);

}  // namespace pleuel
