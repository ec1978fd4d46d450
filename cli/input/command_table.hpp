#pragma once

#include <string>
#include <variant>
#include <vector>

#include "cli/input/arguments.hpp"

namespace CLI {
class Option;
}

namespace pleuel {

/// Where an option puts what the user typed: a member that holds the text or number, one that is true then,
/// or how closely numbers are looked at.
using OptionTarget =
    std::variant<bool Arguments::*, int Arguments::*, double Arguments::*, std::string Arguments::*,
                 fs::path Arguments::*, std::vector<std::string> Arguments::*,
                 std::vector<fs::path> Arguments::*, std::optional<int> Arguments::*,
                 std::optional<double> Arguments::*, std::optional<std::string> Arguments::*,
                 std::optional<fs::path> Arguments::*, Scrutiny>;

/// An option or a positional argument of a command.
struct OptionKind {
  std::string flags;  ///< "-o,--output"; of a positional argument its name
  OptionTarget target;
  std::string description;
  const char* type = "";                  ///< what the help calls its value
  void (*limit)(CLI::Option&) = nullptr;  ///< how often it may come, and with what
};

/// A command as its help tells it, with its options in the order of the help.
struct CommandKind {
  const char *name, *description;
  const char *does, *example;  ///< one to three sentences, and a command line behind "pleuel "
  std::vector<OptionKind> options;
};

/// All commands, in the order in which one meets them.
std::vector<CommandKind> command_kinds();

}  // namespace pleuel
