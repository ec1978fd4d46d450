#pragma once

#include <vector>

/// What becomes of a history.
namespace pleuel {

/// One observed number that a reduced value depends on: d(value)/d(y[step, channel]) = weight.
struct Sample {
  int step;
  int channel;
  double weight;
};

/// Another peak of nearly the same height. In a periodic motion that is no harm: both move alike
/// with the design. Where they do not, the maximum has a kink (see sensitivity/kinks.hpp).
struct PeakTie {
  double time = 0.0, other_time = 0.0;  ///< [s]
  int channel = 0, other_channel = 0;
  double gap = 0.0;                   ///< relative difference of the heights
  std::vector<Sample> other_samples;  ///< what the other height depends on
};

/// A history reduced to one number, linearised in the observed numbers.
struct Reduction {
  double value = 0.0;
  std::vector<Sample> samples;
  std::vector<PeakTie> ties;  ///< by gap, the closest first; of many those that differ most
};

/// Steps first … last of a history.
struct StepRange {
  int first = 0, last = 0;
  int steps() const { return last - first + 1; }
};

/// Whether signals may jump or have a kink at an instant, one an instant; empty: nowhere. Peaks
/// there and beside are samples: no parabola goes through.
using BrokenInstants = std::vector<bool>;

}  // namespace pleuel
