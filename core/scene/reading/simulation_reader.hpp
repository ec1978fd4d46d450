#pragma once

#include "core/scene/problem_file.hpp"
#include "core/scene/reading/number_reader.hpp"

namespace pleuel {

/// Times, scheme, formulation and start. @throws InputError
SimulationSettings read_simulation(const JsonNode& node, NumberReader& numbers);

}  // namespace pleuel
