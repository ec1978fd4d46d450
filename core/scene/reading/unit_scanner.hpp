#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace pleuel {

/// Whether a name can contain this character (UTF-8 bytes of letters beyond ASCII among them).
bool is_name_character(char c);
bool is_digit_character(char c);

/// Without these around it.
std::string trimmed(std::string_view text, std::string_view covers = " ");

/// A text that is a finite number and nothing else, in the notation of C, with "+" or not.
std::optional<double> plain_number(std::string_view text);

/// Whether a text has a name as a word of its own.
bool has_word(const std::string& text, const std::string& word);

/// How far a unit reaches that begins at the start of a text: "kg/m^3 * width" has the unit
/// "kg/m^3". Words follow each other by a blank or "/", each with a whole power; "/" belongs to the
/// unit only before a word that `is_unit` knows.
/// @returns number of characters; 0: there is none
std::size_t unit_length(std::string_view text,
                        const std::function<bool(const std::string&)>& is_unit);

}  // namespace pleuel
