#pragma once

#include "cli/input/arguments.hpp"
#include "cli/reports/outcome.hpp"

namespace pleuel {

/// Runs the command that these arguments name, for every load case if they ask for it. Nothing of its outcome
/// is printed.
/// @throws InputError and SimulationError, whose messages name the file
Outcome run_command(const Arguments& arguments);

}  // namespace pleuel
