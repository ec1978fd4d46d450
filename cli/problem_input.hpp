#pragma once

#include <string>

#include "cli/arguments.hpp"
#include "cli/json.hpp"
#include "core/scene/problem_file.hpp"

namespace pleuel {

/// A problem file as a command sees it.
struct ProblemInput {
  ProblemFile problem;
  Json effective;    ///< the file with all overrides applied
  std::string hash;  ///< of the file's text and the overrides: "fnv1a64:…"
};

/// @throws InputError
ProblemInput read_input(const Arguments& arguments);

}  // namespace pleuel
