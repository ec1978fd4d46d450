#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// Other programs that this one starts.
namespace pleuel {

/// As long as one of them exists, this process may start the programs that problem files name: the
/// user said so.
class ProgramPermission {
 public:
  ProgramPermission();
  ~ProgramPermission();
  ProgramPermission(const ProgramPermission&) = delete;
  ProgramPermission& operator=(const ProgramPermission&) = delete;
};
bool may_start_programs();

struct ChildProgram {
  std::vector<std::string> command;  ///< the program, looked for in PATH, and its arguments
  std::filesystem::path folder;      ///< that it runs in; empty: this one
  double time_limit = 0.0;           ///< [s]; 0: any time
};

/// "python3 conrod.py": for messages.
std::string command_text(const ChildProgram& program);

/// Starts a program, gives it a text on its standard input, and waits for its end.
/// @returns what it wrote to standard output
/// @throws SimulationError if it cannot be started, ends with another code than 0, is ended by a signal
///         or takes longer than its limit; with the end of what it wrote to standard error
std::string output_of(const ChildProgram& program, const std::string& input);

}  // namespace pleuel
