#pragma once

#include <Eigen/Core>

#include "core/trust/doubts.hpp"
#include "optimization/design/design_problem.hpp"

namespace pleuel {

/// How far the numbers of a design can be trusted, of all load cases: one error, one evidence and
/// one band a response of the joined problem. Doubts say which cases they are of; one that all cases
/// share stands once.
/// @param x  that can be simulated
Trust judge_cases(DesignProblem& design, const Eigen::VectorXd& x, Scrutiny scrutiny);

}  // namespace pleuel
