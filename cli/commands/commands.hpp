#pragma once

/// The commands of the program, one file each, and what they are made of. All throw InputError and
/// SimulationError.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cli/commands/progress_line.hpp"
#include "cli/files/csv_file.hpp"
#include "cli/files/older_run.hpp"
#include "cli/files/run_picture.hpp"
#include "cli/files/run_store.hpp"
#include "cli/input/problem_input.hpp"
#include "cli/input/run_setting.hpp"
#include "cli/reports/limits_report.hpp"
#include "cli/text/console.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/error.hpp"
#include "core/base/number_text.hpp"
#include "core/base/stop.hpp"
#include "core/trust/checks.hpp"

namespace pleuel {

/// read_input() with steps, elements and effects for the accuracy, where the file or the command line
/// names one; says so in a line. @throws InputError
ProblemInput read_input_with_accuracy(const Arguments& arguments);

Outcome run_accuracy(const Arguments& arguments);
Outcome run_uncertainty(const Arguments& arguments);
Outcome run_backends(const Arguments& arguments);
Outcome run_compare(const Arguments& arguments);
Outcome run_completion(const Arguments& arguments);
Outcome run_check(const Arguments& arguments);
Outcome run_export(const Arguments& arguments);
Outcome run_gradient(const Arguments& arguments);
Outcome run_invariants(const Arguments& arguments);
Outcome run_new(const Arguments& arguments);
Outcome run_optimize(const Arguments& arguments);
Outcome run_pareto(const Arguments& arguments);
Outcome run_plot(const Arguments& arguments);
Outcome run_prices(const Arguments& arguments);
Outcome run_reduce(const Arguments& arguments);
Outcome run_report(const Arguments& arguments);
Outcome run_runs(const Arguments& arguments);
Outcome run_schema(const Arguments& arguments);
Outcome run_show(const Arguments& arguments);
Outcome run_simulate(const Arguments& arguments);
Outcome run_stability(const Arguments& arguments);

// Of a command that looks at one design, for each load case of its file.

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

// Mechanisms of earlier runs.

/// What is told of files that cannot be used.
using Notes = std::vector<std::string>;

/// What the page of an older run shows of its mechanism (run_picture()): its designs are simulated again
/// from the run card. Null of a run of several files.
/// @throws std::exception if that is not possible any more
Json picture_of_run(const OlderRun& run, Notes& notes);

}  // namespace pleuel
