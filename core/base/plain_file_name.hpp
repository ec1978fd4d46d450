#pragma once

#include <string>

namespace pleuel {

/// A text as part of a file name: "_" in place of all but letters, digits, "-" and ".".
std::string plain_file_name(const std::string& text);

}  // namespace pleuel
