#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/base/error_bar.hpp"
#include "core/response/linearized_expression.hpp"
#include "core/trust/checks.hpp"
#include "optimization/design/design_problem.hpp"

namespace pleuel {

/// How far the numbers of a design can be trusted, of all load cases: one error, one evidence and
/// one band a response of the joined problem. Findings say which cases they are of; one that all cases
/// share stands once.
/// @param x  that can be simulated
Trust judge_cases(DesignProblem& design, const Eigen::VectorXd& x, Scrutiny scrutiny);

/// The error of Σ weight · response. The runs of a case are its own: errors cancel within a case only.
/// @param parts      responses of single cases, by their places in the joined problem
/// @param magnitude  what errors are small beside
/// @returns nothing where no error is known
std::optional<ErrorBar> error_of_sum(const ProblemFile& joined, const Trust& trust,
                                     const std::vector<WeightedResponse>& parts, double magnitude);

}  // namespace pleuel
