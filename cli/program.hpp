#pragma once

#include "cli/input/arguments.hpp"
#include "cli/reports/outcome.hpp"

namespace pleuel {

/// What the command `pleuel` does: runs a command line, as a rank of a job where mpirun started it, prints the
/// outcome, and takes signals for a request to end.
/// @returns  the exit code
int run_program(int argc, const char* const* argv) noexcept;

/// Runs the command that these arguments name, for every load case if they ask for it. Nothing of its outcome
/// is printed.
/// @throws InputError and SimulationError, whose messages name the file
Outcome run_command(const Arguments& arguments);

}  // namespace pleuel
