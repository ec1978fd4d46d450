#pragma once

#include "core/scene/body_constants.hpp"
#include "core/scene/reading/json_node.hpp"

namespace pleuel {

/// What the numbers of a body must fulfil, whoever wrote them.
/// @param node  the file, to say where it is wrong
/// @throws InputError
void check_constants(const JsonNode& node, const BodyConstants& constants);

/// The same of a derivative: symmetry, and S_xx + S_yy + S_zz = mass matrix.
void check_derivative(const JsonNode& node, const BodyConstants& change);

}  // namespace pleuel
