#pragma once

#include "core/scene/reading/json_text.hpp"

namespace pleuel {

/// Sets one value of the document: "/json/pointer=value". The value is JSON if it can be read as
/// such, else a text, so that units need no quotes. The pointer must lead to a value, or to a new
/// key of an object that is there. "name=value" is the start of the design variable of this name.
/// @throws InputError
void apply_override(Json& document, const std::string& assignment, const std::string& file);

/// Sets the value at a pointer, by the same rules.
/// @param pointer  begins with "/"
/// @param whose    how messages name what asks for it
/// @throws InputError
void replace_at(Json& document, const std::string& pointer, const Json& value,
                const std::string& whose, const std::string& file);

/// Of people's assignments: "0.1" in place of "0.2 mm" may mean 0.1 mm, or 0.1 m as the number in SI
/// that it is.
/// @throws InputError with both if the assignment is a number and the document has one with a unit
void require_unit(const Json& document, const std::string& assignment, const std::string& file);

/// What stands before the "=" of an assignment, without spaces around it: a pointer, or the name of
/// a variable.
std::string assigned_place(const std::string& assignment);

/// The same place as a pointer: that of the variable's start if it is called by its name.
std::string assigned_pointer(const std::string& assignment);

}  // namespace pleuel
