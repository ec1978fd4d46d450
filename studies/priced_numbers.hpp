#pragma once

#include <string>
#include <vector>

#include "core/scene/problem_numbers.hpp"

namespace pleuel {

struct PricedNumbers {
  std::vector<NumberGroup> groups;
  /// Names of groups that would have a price, but no variable can stand for them: a place on an
  /// elastic beam.
  std::vector<std::string> left_out;
};

/// The fixed numbers of a scene that a price can be given for, grouped: a point that bodies, joints
/// and loads share moves as one. Left out are coordinates across the plane of a planar mechanism
/// and those of places where a variable or a formula moves another point, numbers other than
/// coordinates that are zero (nothing says that they belong to the mechanism), and what no variable
/// can stand for.
PricedNumbers priced_numbers(const ProblemText& text, const ProblemFile& problem);

}  // namespace pleuel
