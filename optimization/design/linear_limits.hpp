#pragma once

#include <string>

#include "core/scene/problem_file.hpp"
#include "optimization/design/design_problem.hpp"

namespace pleuel {

/// @throws InputError  naming the linear limits of a file that contradict each other or the bounds of its
///                     variables (linear_choice.hpp)
void require_linear_limits(const ProblemFile& file);

/// What to do about natural frequencies that are optimized and coincide with that of the next or the
/// last mode at a design: modes are counted by their frequencies, so that each has a kink where two
/// meet, and an optimum there is none of first order. Empty where none does, or if the design cannot
/// be simulated.
std::string advise_on_meeting_frequencies(DesignProblem& design, const Eigen::VectorXd& x);

}  // namespace pleuel
