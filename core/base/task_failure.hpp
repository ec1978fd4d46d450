#pragma once

#include <string>

namespace pleuel {

/// What a task throws, for the process that handed it out. To be called while it is being handled:
/// InputError, SimulationError, std::bad_alloc, Stopped and everything of the standard library.
std::string thrown_report();

/// Whether it is a Stopped.
bool is_stop(const std::string& report);

/// Throws what was reported: the same type, or std::runtime_error.
[[noreturn]] void throw_again(const std::string& report);

}  // namespace pleuel
