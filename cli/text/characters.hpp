#pragma once

#include <cstddef>
#include <string>

namespace pleuel {

/// Number of characters of a UTF-8 text.
std::size_t characters(const std::string& text);

}  // namespace pleuel
