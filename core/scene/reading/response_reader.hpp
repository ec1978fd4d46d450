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

/// A response that is a formula of other responses, variables and constants.
/// @param node   {"type": "expression", "value", "unit"}
/// @param known  all responses of the file that have a quantity already, with their places in it
/// @throws InputError
ResponseSettings read_expression_response(const std::string& name, const JsonNode& node,
                                          const std::vector<ResponseSettings>& known,
                                          NumberReader& numbers);

/// The response that a node names; where it is a formula ("= a - b"), that is made a response of
/// its own, called by its text, at the end of the list; of max(…) and min(…) the formulas in it, too.
/// @throws InputError
ResponseSettings& read_response_or_formula(const JsonNode& node,
                                           std::vector<ResponseSettings>& responses,
                                           NumberReader& numbers);

}  // namespace pleuel
