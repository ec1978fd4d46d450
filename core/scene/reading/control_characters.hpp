#pragma once

#include <cstddef>
#include <string_view>

/// What a terminal or a page would obey instead of showing it: C0, DEL, C1, separators of lines
/// (U+2028 …) and what turns the direction of the writing that follows, so that a name reads as
/// another one (U+202A … U+202E, U+2066 … U+206F).
namespace pleuel {

/// Bytes of the UTF-8 character that begins there; 0 if none does, or one that is not to be shown.
std::size_t shown_character(std::string_view text);

/// @param allowed  of these
bool has_control_character(std::string_view text, std::string_view allowed = "");

}  // namespace pleuel
