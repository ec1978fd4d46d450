#pragma once

#include "core/scene/problem_file.hpp"

/// Studies say what their settings could be, in names and units of the file.
namespace pleuel {

/// @throws InputError with an example if there is no "pareto"
void require_pareto(const ProblemFile& problem);

/// @throws InputError with an example if there is no "uncertainty"
void require_uncertainty(const ProblemFile& problem);

}  // namespace pleuel
