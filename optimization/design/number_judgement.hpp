#pragma once

#include "core/trust/trusted_run.hpp"
#include "optimization/design/design_problem.hpp"
#include "optimization/result.hpp"

namespace pleuel {

/// Findings about the numbers of the last design, and their errors: no optimum that rests on numbers
/// which are not to be trusted, or not known as well as the file asks for, is verified.
/// @param result  gets warnings, errors, bands and the objectives of all cases; its status may change
void judge_numbers(DesignProblem& design, Scrutiny scrutiny, Result& result);

}  // namespace pleuel
