#pragma once

#include "core/scene/body_constants.hpp"
#include "core/scene/reading/json_text.hpp"

namespace pleuel {

/// Derivatives of constants, as a block of the "derivatives" of a file of invariants has them.
Json derivative_json(const BodyConstants& change);

}  // namespace pleuel
