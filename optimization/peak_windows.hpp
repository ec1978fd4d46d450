#pragma once

#include "optimization/design_problem.hpp"

namespace pleuel {

/// Whether a response is the height of a peak of a history.
bool has_peaks(const ResponseSettings& response);

/// The peaks of a response in so many equal windows of time, at a simulated design.
std::vector<Reduction> peaks_of_windows(const Analysis& analysis, std::size_t response,
                                        int windows);

/// Channels of a response that belong together: a place.
struct ChannelRange {
  Eigen::Index first = 0, count = 0;
};

/// Into how many places a response of many channels is to be split, since the place of its peak
/// changes with the design: the stress of a whole beam into its segments, that of one segment, or
/// of an imported body, into a few parts; everything else is one place.
int place_count(const ProblemFile& file, const ResponseSettings& response);

/// So many places, at a simulated design. Places may share channels if there are too few.
std::vector<ChannelRange> places_of(const Analysis& analysis, const ProblemFile& file,
                                    std::size_t response, int places);

/// The peaks of each window of time at each place, place by place.
std::vector<Reduction> peaks_of_places(const Analysis& analysis, std::size_t response,
                                       const std::vector<ChannelRange>& places, int windows);

/// Into how many windows of time the optimized responses are to be split at a design, so that no
/// two peaks that tie (within 0.1 %, at different times, with gradients that differ by more than a
/// hundredth) stand in one: `fewest`, or twice, four times … as many, up to `most`. Only windows
/// count whose peak is within 1 % of the highest. Costs a gradient for each number that is tried.
/// Of several load cases the one that needs most of them counts.
/// @returns `fewest` if the design cannot be simulated
int windows_that_part_peaks(DesignProblem& problem, const Eigen::VectorXd& x, int fewest, int most);

/// The objective and what constraints limit in a case, in this order; indices of its responses. Of
/// an expression those that it is made from.
std::vector<std::size_t> optimized_responses(const DesignCase& problem);

}  // namespace pleuel
