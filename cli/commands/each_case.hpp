#pragma once

#include "cli/input/arguments.hpp"
#include "cli/reports/outcome.hpp"

namespace pleuel {

/// Whether the file of a command that looks at one design has load cases, and none of them is
/// named: then it runs for each.
bool asks_for_each_case(const Arguments& arguments);

/// Of a command for one load case: which limits of the file it could not look at, as a sentence;
/// empty if there are none.
std::string limits_left_out_text(const Arguments& arguments);

/// The command for one load case after the other, each with a run folder of its own: that of the
/// command line is the one that theirs are in.
/// @returns {"cases": {NAME: result}}, and the most serious exit code
Outcome run_each_case(const Arguments& arguments, Outcome (*command)(const Arguments&));

}  // namespace pleuel
