#pragma once

#include "core/scene/body_constants.hpp"
#include "core/scene/reading/json_node.hpp"

namespace pleuel {

/// The blocks "invariants", "places", "stress" and "stiffening" of a file of invariants.
/// @param coordinates  n
/// @throws InputError
BodyConstants read_constants(const JsonNode& node, int coordinates);

/// The same blocks of a derivative; what is missing is zero. @throws InputError
BodyConstants read_derivative(const JsonNode& node, const BodyConstants& of);

}  // namespace pleuel
