#pragma once

#include "cli/input/arguments.hpp"
#include "cli/text/json.hpp"
#include "core/scene/problem_file.hpp"
#include "optimization/solve.hpp"

namespace pleuel {

/// Options of the file, with the command line's backend. Where neither names one, others may follow
/// on the default.
/// @throws InputError if there is no such backend
SolveOptions solve_options(const ProblemFile& problem, const Arguments& arguments);

/// For the run card.
Json options_document(const SolveOptions& options, const ProblemFile& problem);

}  // namespace pleuel
