#pragma once

#include "cli/input/problem_input.hpp"
#include "studies/accuracy_optimum.hpp"

namespace pleuel {

/// The result of the command accuracy; docs/reference/commands.md.
Json accuracy_document(const ProblemInput& input, const AccuracyStudy& study);

/// What whole optimizations add to it.
void add_optima(const ProblemInput& input, const OptimumStudy& optima, Json& document);

/// An entry of its "runs".
Json run_document(const ProblemFile& problem, const AccuracyRun& run);

/// {POINTER: value} of what --set has to change for a setting.
Json overrides_document(const ProblemInput& input, const Discretization& settings);

/// {"step", "elements"} or {"step", "element_factor"}
Json settings_document(const Discretization& settings);

/// What speaks against the reference and the setting that is recommended.
std::vector<std::string> warnings_of(const AccuracyStudy& study);

}  // namespace pleuel
