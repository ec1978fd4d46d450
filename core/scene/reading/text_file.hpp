#pragma once

#include <filesystem>
#include <string>

namespace pleuel {

/// The text of a file. @throws InputError if there is none, or it cannot be read or is huge.
std::string read_text_file(const std::filesystem::path& path);

}  // namespace pleuel
