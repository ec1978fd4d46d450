#pragma once

#include <optional>

#include "cli/input/arguments.hpp"

namespace pleuel {

/// @returns nothing if help or the version was asked for and printed
/// @throws InputError for anything that is not a command line of pleuel
std::optional<Arguments> parse_arguments(int argc, const char* const* argv);

}  // namespace pleuel
