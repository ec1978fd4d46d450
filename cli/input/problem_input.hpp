#pragma once

#include "cli/input/arguments.hpp"
#include "cli/text/json.hpp"
#include "core/scene/problem_numbers.hpp"
#include "core/trust/setting_choice.hpp"

namespace pleuel {

/// The design in a document with "variables": {NAME: {"value", …}}: the result.json of an
/// optimization, or the failed_design.json beside it. Values are numbers in SI, which read back
/// exactly, numbers with a "unit" beside them, or texts such as "12 mm". By hand it is shorter:
/// {NAME: "12 mm", …}. Of a folder it is the result.json inside.
/// @throws InputError if there is no such file, if it does not give every variable of the problem
///         and no other one a value within its bounds, or if a unit is not that of the variable
Eigen::VectorXd read_design(const std::filesystem::path& path, const ProblemFile& problem);

/// A problem file as a command sees it.
struct ProblemInput {
  fs::path file;
  ProblemFile problem;      ///< with the method of the command line
  Eigen::VectorXd design;   ///< [SI]: that of --design, else the start
  std::string design_name;  ///< "design" or "start": what people read of it
  ProblemText text;         ///< what it was read from
  Json effective;           ///< the file with all overrides applied
  std::string hash;         ///< of the file's text, the overrides and another design: "fnv1a64:…"
  /// Steps and elements that were chosen at the design; the problem has them.
  std::optional<SettingChoice> choice;
};

/// The design that a command looks at: that of --design, else the start, with values of variables that
/// the command line sets [SI].
Eigen::VectorXd design_of(const Arguments& arguments, const ProblemFile& problem);

/// Of what `--set` says, before anything else is added to it.
/// @throws InputError where it is a plain number and the file has one with a unit
void require_units(const Arguments& arguments);

/// The file of a command that takes one. @throws InputError
ProblemInput read_input(const Arguments& arguments);

/// Those of a command that takes several. @throws InputError
std::vector<ProblemInput> read_inputs(const Arguments& arguments);

/// Whether the user asks what becomes of a design of theirs: one that breaks a limit is no success
/// then, as the start of a search is.
bool tries_a_design(const Arguments& arguments);

}  // namespace pleuel
