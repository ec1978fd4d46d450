#pragma once

#include <cstddef>
#include <string>

namespace pleuel {

/// Number of characters of a UTF-8 text.
std::size_t characters(const std::string& text);

/// "geometric stiffening" of a key "geometric_stiffening".
std::string words_of(std::string key);

/// The text, or so many characters of it with "…" as the last one.
std::string shortened(std::string text, std::size_t most);

/// Characters in a line of what people read: of the terminal that standard output is, or as many as
/// COLUMNS says, at least 80 and at most 160; 100 where nobody says.
std::size_t line_width();

/// The text with line breaks between words, so that no line is longer than `width` characters where
/// words allow that. Lines that are in it already stay apart.
/// @param indent  what the lines begin with that are added
std::string wrapped(const std::string& text, const std::string& indent = "",
                    std::size_t width = line_width());

}  // namespace pleuel
