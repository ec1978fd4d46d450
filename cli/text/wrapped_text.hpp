#pragma once

#include <cstddef>
#include <string>

namespace pleuel {

/// Characters in a line of what people read.
inline constexpr std::size_t line_width = 100;

/// The text with line breaks between words, so that no line is longer than `width` characters where
/// words allow that. Lines that are in it already stay apart.
/// @param indent  what the lines begin with that are added
std::string wrapped(const std::string& text, const std::string& indent = "",
                    std::size_t width = line_width);

}  // namespace pleuel
