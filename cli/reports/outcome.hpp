#pragma once

#include <cstddef>

#include <fmt/format.h>

#include "cli/text/json.hpp"

namespace pleuel {

enum class ExitCode {
  done = 0,
  fault = 1,      ///< ours, or a result that could not be written
  bad_input = 2,  ///< of the problem file or the command line
  simulation_failed = 3,
  not_verified = 4  ///< ended without a verified optimum, or interrupted
};

/// What a command leaves behind. Only main() prints it, one of the two ways.
struct Outcome {
  ExitCode exit_code = ExitCode::done;
  Json document;     ///< for --json and result.json
  std::string text;  ///< for people
  /// Files that could not be written, as on a full disk.
  std::vector<std::string> unwritten{};

  int final_code() const {
    return static_cast<int>(unwritten.empty() ? exit_code : ExitCode::fault);
  }
};

/// "done" or "interrupted": of a study that can tell what it knows so far.
inline std::string study_status(bool is_whole) {
  return is_whole ? "done" : "interrupted";
}

/// "INTERRUPTED: 3 of 7 points were done\n\n"
inline std::string interrupted_text(std::size_t done, std::size_t all, const std::string& what) {
  return fmt::format("INTERRUPTED: {} of {} {} were done\n\n", done, all, what);
}

}  // namespace pleuel
