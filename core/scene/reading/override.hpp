#pragma once

#include <string>

#include "core/scene/reading/json_text.hpp"

namespace pleuel {

/// Sets one value of the document: "/json/pointer=value". The value is JSON if it can be read as
/// such, else a text, so that units need no quotes. The pointer must lead to a value, or to a new
/// key of an object that is there. "name=value" is the start of the design variable of this name.
/// @throws InputError
void apply_override(Json& document, const std::string& assignment, const std::string& file);

}  // namespace pleuel
