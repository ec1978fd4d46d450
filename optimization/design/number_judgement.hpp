#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "core/base/error_bar.hpp"
#include "core/trust/checks.hpp"
#include "core/trust/trusted_run.hpp"
#include "optimization/design/design_problem.hpp"
#include "optimization/result.hpp"

namespace pleuel {

// How far an optimum may be from that of an arbitrarily fine simulation.

/// The errors Δ of objective and limits make of the optimum, by the envelope theorem,
///
///     f*(fine) − f* ≈ Δf + Σ μ_j Δc_j.
///
/// f + Σ μ_j c_j is judged as one value of all the runs: its parts may cancel, which their bars do
/// not know.
/// @param trust  of the optimal design, one error a response of the file
/// @returns nothing where the design has no multipliers that are prices, or no errors are known
std::optional<ErrorBar> optimum_error(DesignProblem& design, const Result& result,
                                      const Trust& trust);

/// What changes of the responses at an optimum make of it by the same theorem.
/// @param changes  one a response of the file [SI]
double optimum_change(DesignProblem& design, const Result& result, const Eigen::VectorXd& changes);

/// Why the optimum is not known to the accuracy that the file asks for, or to 10 % where it asks for
/// none, and what would do; empty if it is. What counts is the error of the objective at the
/// optimum, and that of each limit which the error could break.
std::string inaccuracy(DesignProblem& design, const Result& result, const Trust& trust);

/// Findings about the numbers of the last design, and their errors: no optimum that rests on numbers
/// which are not to be trusted, or not known as well as the file asks for, is verified.
/// @param result  gets warnings, errors, bands and the objectives of all cases; its status may change
void judge_numbers(DesignProblem& design, Scrutiny scrutiny, Result& result);

}  // namespace pleuel
