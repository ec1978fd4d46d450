#pragma once

#include <vector>

#include "core/scene/problem_numbers.hpp"

namespace pleuel {

/// The fixed numbers of a scene that a price can be given for, grouped: a point that bodies, joints
/// and loads share moves as one. Left out are coordinates across the plane of a planar mechanism
/// and those of places where a variable or a formula moves another point, numbers other than
/// coordinates that are zero (nothing says that they belong to the mechanism), and what no variable
/// can stand for.
std::vector<NumberGroup> priced_numbers(const ProblemText& text, const ProblemFile& problem);

}  // namespace pleuel
