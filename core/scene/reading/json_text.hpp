#pragma once

/// What a terminal or a page would obey instead of showing it: C0, DEL, C1, separators of lines
/// (U+2028 …) and what turns the direction of the writing that follows, so that a name reads as
/// another one (U+202A … U+202E, U+2066 … U+206F).

/// From a text to a JSON document, stricter than the library: nothing is lost silently.

#include <cstddef>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace pleuel {

/// Bytes of the UTF-8 character that begins there; 0 if none does, or one that is not to be shown.
std::size_t shown_character(std::string_view text);

/// @param allowed  of these
bool has_control_character(std::string_view text, std::string_view allowed = "");

using Json = nlohmann::ordered_json;

/// Objects and lists inside each other; more is not a problem file.
inline constexpr std::size_t deepest_nesting = 64;

/// @param file  how messages name the text.
/// @throws InputError with line and column for bad syntax, invalid UTF-8 and numbers out of range;
///         with the JSON pointer for a key that is there twice and for too deep nesting.
Json parse_json(const std::string& text, const std::string& file);

/// `parent` extended by a key, escaped as RFC 6901 wants it.
std::string child_pointer(const std::string& parent, const std::string& key);

}  // namespace pleuel
