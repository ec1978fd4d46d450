#pragma once

#include <optional>

#include "cli/input/arguments.hpp"

namespace CLI {
class App;
}

namespace pleuel {

/// @returns nothing if help or the version was asked for and printed
/// @throws InputError for anything that is not a command line of pleuel
std::optional<Arguments> parse_arguments(int argc, const char* const* argv);

/// Declares the commands and their options, which will be written into the arguments.
void add_commands(CLI::App& app, Arguments& arguments);

}  // namespace pleuel
