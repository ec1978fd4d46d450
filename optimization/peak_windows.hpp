#pragma once

#include "optimization/design_problem.hpp"

namespace pleuel {

/// Whether a response is the height of a peak of a history.
bool has_peaks(const ResponseSettings& response);

/// The peaks of a response in so many equal windows of time, at a simulated design.
std::vector<Reduction> peaks_of_windows(const Analysis& analysis, std::size_t response,
                                        int windows);

/// Into how many windows of time the optimized responses are to be split at a design, so that no
/// two peaks that tie (within 0.1 %, at different times, with gradients that differ by more than a
/// hundredth) stand in one: `fewest`, or twice, four times … as many, up to `most`. Only windows
/// count whose peak is within 1 % of the highest. Costs a gradient for each number that is tried.
/// @returns `fewest` if the design cannot be simulated
int windows_that_part_peaks(DesignProblem& problem, const Eigen::VectorXd& x, int fewest, int most);

/// The objective and what constraints limit, in this order; indices of responses.
std::vector<std::size_t> optimized_responses(const DesignProblem& problem);

}  // namespace pleuel
