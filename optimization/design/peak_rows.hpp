#pragma once

#include <vector>

#include "core/response/analysis.hpp"

namespace pleuel {

/// Into how many windows of time, and places, the peaks of a response are told apart.
struct PeakDivision {
  int windows = 1, places = 1;

  int peaks() const { return windows * places; }
};

/// Whether a response is the height of a peak of a history.
bool has_peaks(const ResponseSettings& response);

/// The same, or that it is made from cycles of a history, which can be told apart by places, but not by
/// windows of time.
bool can_be_divided(const ResponseSettings& response);

/// Into how many places a response of many channels is to be split, since the place of its peak
/// changes with the design: the stress or fatigue of a whole beam into its segments, that of one segment
/// into a few parts, that of an imported body into its points; buckling into both planes in which a beam bends, lateral
/// buckling in space only; everything else is one place.
int place_count(const ProblemFile& file, const ResponseSettings& response);

/// The peaks of a response at a simulated design in equal windows of time at each place, place by
/// place. Places may share channels if there are too few.
/// @param response  index; can_be_divided(), and places are 1 or place_count();
///                  windows of fatigue are 1
std::vector<Reduction> divided_peaks(const Analysis& analysis, const ProblemFile& file,
                                     std::size_t response, const PeakDivision& division);

}  // namespace pleuel
