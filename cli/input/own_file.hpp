#pragma once

#include <filesystem>

namespace pleuel {

/// The file that this code was loaded from: the shared library, wherever the program that uses it is.
std::filesystem::path own_file();

}  // namespace pleuel
