#pragma once

#include "cli/input/arguments.hpp"

namespace pleuel {

/// A command that looks at the design of an optimization (--design) does so with the steps,
/// elements and tolerance of effects that the optimum was found with, where those were chosen for
/// an accuracy: they become overrides before all others, and a note on standard error says so.
/// Each load case has its own. Nothing changes where the file or the command line asks for an
/// accuracy, and of designs that are no result of a run; of runs of another mechanism a note says
/// that theirs is not taken.
void take_setting_of_run(Arguments& arguments);

}  // namespace pleuel
