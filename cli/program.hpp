#pragma once

namespace pleuel {

/// What the command `pleuel` does: runs a command line, as a rank of a job where mpirun started it, prints the
/// outcome, and takes signals for a request to end.
/// @returns  the exit code
int run_program(int argc, const char* const* argv) noexcept;

}  // namespace pleuel
