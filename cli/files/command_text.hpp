#pragma once

#include "cli/input/arguments.hpp"

namespace pleuel {

/// A word as a shell wants it.
std::string shell_word(const std::string& word);

/// The command line as it was typed, but for --overwrite.
std::string typed_command(const Arguments& arguments);

/// The line for a shell that runs a command on a file.
std::string command_on(const std::string& command, const Arguments& arguments,
                       const fs::path& file);

}  // namespace pleuel
