#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Help for a misspelt name.
namespace pleuel {

/// Number of insertions, deletions, replacements and swaps of neighbours that turn one word into
/// the other (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The known word that is probably misspelt, or an empty string.
std::string closest(std::string_view word, const std::vector<std::string>& known);

/// The known word that is probably meant, by another name (other_names.hpp) or misspelt, or an empty string.
std::string meant_by(std::string_view word, const std::vector<std::string>& known);

/// `"a", "b" and "c"`, the last two joined by `conjunction`.
std::string quoted_list(const std::vector<std::string>& words, std::string_view conjunction);

/// The end of a message about an unknown word: `; did you mean "steel"?`, else `; known are …`.
std::string hint(std::string_view word, const std::vector<std::string>& known);

}  // namespace pleuel
