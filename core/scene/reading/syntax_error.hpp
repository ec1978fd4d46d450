#pragma once

#include <cstddef>
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
/// @param position  up to which a parser came: what counts where nothing is found
/// @param reason    what it says of that
std::string describe_syntax_error(const std::string& text, std::size_t position,
                                  const std::string& reason);

}  // namespace pleuel
