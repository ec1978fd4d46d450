#pragma once

#include "cli/input/arguments.hpp"
#include "cli/text/json.hpp"
#include "core/scene/problem_file.hpp"
#include "optimization/solve.hpp"

namespace pleuel {

/// A command that looks at the design of an optimization (--design) does so with the steps,
/// elements and tolerance of effects that the optimum was found with, where those were chosen for
/// an accuracy: they become overrides before all others, and a note on standard error says so.
/// Each load case has its own. Nothing changes where the file or the command line asks for an
/// accuracy, and of designs that are no result of a run; of runs of another mechanism a note says
/// that theirs is not taken.
void take_setting_of_run(Arguments& arguments);

/// Options of the file, with the command line's backend. Where neither names one, others may follow
/// on the default.
/// @throws InputError if there is no such backend
SolveOptions solve_options(const ProblemFile& problem, const Arguments& arguments);

/// For the run card.
Json options_document(const SolveOptions& options, const ProblemFile& problem);

}  // namespace pleuel
