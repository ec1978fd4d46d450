#pragma once

#include "core/scene/problem_file.hpp"
#include "core/scene/reading/json_node.hpp"
#include "core/scene/reading/number_reader.hpp"

/// What is asked of a simulation: optimizer, accuracy, uncertainty. All throw InputError.
namespace pleuel {

/// Whether the backend is there is for the optimizer to say.
OptimizerSettings read_optimizer(const JsonNode& node, const std::vector<DesignVariable>& variables,
                                 NumberReader& numbers);

AccuracySettings read_accuracy(const JsonNode& node, const std::vector<ResponseSettings>& responses,
                               const NumberReader& numbers);
UncertaintySettings read_uncertainty(const JsonNode& node, const NumberReader& numbers,
                                     const std::vector<DesignVariable>& variables);

/// Times, scheme, formulation and start. @throws InputError
SimulationSettings read_simulation(const JsonNode& node, NumberReader& numbers);

/// Effects that are asked for in so many words have to be possible with the bodies that there are.
void check_effects(const JsonNode& node, const ProblemFile& problem);

}  // namespace pleuel
