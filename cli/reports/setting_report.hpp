#pragma once

#include "cli/input/problem_input.hpp"
#include "optimization/design/staged_solve.hpp"

/// Which steps and elements were chosen for an accuracy.
namespace pleuel {

/// {POINTER: value}: what --set has to change in the file for these steps, elements and tolerance
/// of effects.
Json overrides_document(const Json& effective, const ProblemFile& divided);

/// {"target", "met", "step", "elements", "error", "response", "overrides", "tried"} [SI]
Json setting_document(const ProblemInput& input, const SettingChoice& choice);

/// "For 0.1 %: a step of 0.2 ms and 8 elements, …": a line.
std::string setting_text(const ProblemFile& problem, const SettingChoice& choice);

/// One a stage: {"target", "met", "step", "elements", "error", "evaluations", "choice_seconds",
/// "seconds"}; of a stage with the setting of the file only the last ones.
Json stages_document(const std::vector<Stage>& stages);

/// The stages as a table; empty if nothing was chosen.
std::string stages_text(const std::vector<Stage>& stages);

}  // namespace pleuel
