#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace pleuel {

/// What is wrong with a text that is no JSON, and what its author most likely meant, with the line
/// and a caret below the place:
///
///     line 3, column 18: the comma before this } is too many
///        3 |   "depth": "2 mm",}
///          |                  ^
///
/// Lines of at most 90 characters; what a terminal would obey is shown as "?".
/// @param position  how many bytes the parser of nlohmann-json has read
/// @param said      by the parser
std::string describe_syntax_error(const std::string& text, std::size_t position,
                                  const std::string& said);

/// The text of a file. @throws InputError if there is none, or it cannot be read or is huge.
std::string read_text_file(const std::filesystem::path& path);

// What a terminal or a page would obey instead of showing it: C0, DEL, C1, separators of lines
// (U+2028 …) and what turns the direction of the writing that follows, so that a name reads as
// another one (U+202A … U+202E, U+2066 … U+206F).

/// Bytes of the UTF-8 character that begins there; 0 if none does, or one that is not to be shown.
std::size_t shown_character(std::string_view text);

/// @param allowed  of these
bool has_control_character(std::string_view text, std::string_view allowed = "");

}  // namespace pleuel
