#pragma once

#include "core/scene/problem_file.hpp"
#include "core/scene/reading/number_reader.hpp"

/// Which effects are simulated. Both throw InputError.
namespace pleuel {

EffectSettings read_effects(const JsonNode& node, NumberReader& numbers);

/// What is asked for in so many words has to be possible with the bodies that there are.
void check_effects(const JsonNode& node, const ProblemFile& problem);

}  // namespace pleuel
