#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

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

}  // namespace pleuel
