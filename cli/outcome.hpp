#pragma once

#include <string>

#include "cli/json.hpp"

namespace pleuel {

enum class ExitCode {
  done = 0,
  fault = 1,      ///< ours
  bad_input = 2,  ///< of the problem file or the command line
  simulation_failed = 3,
  not_verified = 4  ///< ended without a verified optimum
};

/// What a command leaves behind. Only main() prints it, one of the two ways.
struct Outcome {
  ExitCode exit_code = ExitCode::done;
  Json document;     ///< for --json and result.json
  std::string text;  ///< for people
};

}  // namespace pleuel
