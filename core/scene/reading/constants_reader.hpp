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

/// @param coordinates  of the body
/// @throws InputError
BodySurface read_surface(const JsonNode& node, int coordinates);

/// What the numbers of a body must fulfil, whoever wrote them.
/// @param node  the file, to say where it is wrong
/// @throws InputError
void check_constants(const JsonNode& node, const BodyConstants& constants);

/// The same of a derivative: symmetry, and S_xx + S_yy + S_zz = mass matrix.
void check_derivative(const JsonNode& node, const BodyConstants& change);

}  // namespace pleuel
