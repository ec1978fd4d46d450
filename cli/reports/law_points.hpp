#pragma once

#include <string>
#include <vector>

#include "core/model/scene_geometry.hpp"

namespace pleuel {

/// A function of time as points of a curve [SI].
struct LawPoints {
  std::vector<double> times, values;

  double lowest() const;
  double highest() const;
};

/// From the start to the end, with the kinks and jumps of a table.
LawPoints law_points(const TimeFunction& function, double end_time, const Design<double>& design,
                     LawOf purpose);

/// "0 … 200 N"; "20 N" of what stays the same; "−5 … 5 mm".
/// @param si  unit of the values
std::string range_text(const LawPoints& points, const std::string& si);

}  // namespace pleuel
