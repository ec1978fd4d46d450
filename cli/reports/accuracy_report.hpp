#pragma once

#include "cli/input/problem_input.hpp"
#include "cli/text/log_log_chart.hpp"
#include "studies/accuracy_optimum.hpp"

namespace pleuel {

/// What the command accuracy prints: the answer as sentences first, then the tables behind it.
/// @param optima  whole optimizations; null without
std::string accuracy_text(const ProblemFile& problem, const AccuracyStudy& study,
                          const OptimumStudy* optima, bool is_verbose);

/// "4 elements a segment", "the elements of the file", "0.5 times the elements of the file"
std::string division_text(const Discretization& settings);

/// "4", "×0.5"
std::string elements_text(const Discretization& settings);

/// "a step of 0.2 ms and 4 elements a segment"
std::string setting_text(const Discretization& settings);

/// "formulation stabilized-index-2", "geometric_stiffening off"
std::string variation_text(const Variation& variation);

/// "9.7 ms", "140 ms"
std::string milliseconds(double seconds);

/// "1 %", "0.1 %"
std::string target_text(double target);

/// "+7.8 g", "−0.2 mm": a change in the unit of a response, masses in grams.
std::string change_text(const ResponseSettings& response, double change);

// As documents.

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

// Work–precision diagrams: time of each setting against its error.

/// Time of a simulation against the largest error of the values that count.
LogLogChart value_chart(const ProblemFile& problem, const AccuracyStudy& study);

/// Time of a simulation with all gradients against the largest error of those that count.
/// @pre the problem has variables
LogLogChart gradient_chart(const ProblemFile& problem, const AccuracyStudy& study);

/// Time of a whole optimization against the error of its optimum.
LogLogChart optimum_chart(const ProblemFile& problem, const OptimumStudy& optima);

}  // namespace pleuel
