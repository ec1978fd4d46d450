#pragma once

#include "cli/input/arguments.hpp"

/// Files that the program carries with it: problems to begin with, and the schema of problem files.
namespace pleuel {

struct Starter {
  std::string kind;         ///< "four-bar"
  std::string description;  ///< a line
  std::string text;         ///< of the problem file
};

/// problems/starters, the simplest first.
std::vector<Starter> starters();

/// problems/problem.schema.json
std::string problem_schema();

/// How the problem files that the program writes call the schema beside them.
inline constexpr const char* schema_name = "problem.schema.json";

/// Writes a file that the user named. @throws InputError if there is one of another text and it
/// shall not be overwritten, or if the text cannot be written
void write_given_file(const fs::path& path, const std::string& text, const Arguments& arguments);

}  // namespace pleuel
