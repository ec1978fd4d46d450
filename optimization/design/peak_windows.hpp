#pragma once

#include <string>

#include "core/scene/problem_file.hpp"
#include "optimization/design/design_problem.hpp"

namespace pleuel {

/// Into how many windows of time the optimized responses are to be split at a design, so that no
/// two peaks of one place (place_count()) that tie stand in one: `fewest`, or twice, four times …
/// as many, up to `most`. Peaks tie within 0.1 %, at different times, with gradients that differ by
/// more than a hundredth. Only windows count whose peak is within 1 % of the highest. Costs a
/// gradient for each number that is tried. Of several load cases the one that needs most counts.
/// @returns `fewest` if the design cannot be simulated
int windows_that_part_peaks(DesignProblem& problem, const Eigen::VectorXd& x, int fewest, int most);

/// The objective and what constraints limit in a case, in this order; indices of its responses. Of
/// an expression those that it is made from; of one over cases those that are of this case.
std::vector<std::size_t> optimized_responses(const DesignProblem& design, std::size_t load_case);

/// The peaks that tie at a design, of the objective and of what is limited: the closest two of each
/// response. Empty if there are none, or if the design cannot be simulated.
std::string tying_peaks(DesignProblem& design, const Eigen::VectorXd& x);

/// What to do about natural frequencies that are optimized and coincide with that of the next or the
/// last mode at a design: modes are counted by their frequencies, so that each has a kink where two
/// meet, and an optimum there is none of first order. Empty where none does, or if the design cannot
/// be simulated.
std::string advise_on_meeting_frequencies(DesignProblem& design, const Eigen::VectorXd& x);

}  // namespace pleuel
