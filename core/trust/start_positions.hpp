#pragma once

#include <vector>

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Positions that the file gives and joints and drives do not let be, where they leave open which
/// others they are: as a drive that begins at an angle between two bodies that are both free to
/// turn. The mechanism starts as close to the file as possible, by lengths and angles, which are
/// compared by the size of the mechanism at the start of its variables; serious where another
/// measure, of which angles or one direction count more, moves a body by more than a hundredth of
/// this size, or of a radian.
std::vector<Finding> check_open_positions(const TrustedRun& run);

/// Limits on the largest value alone (or the smallest) of what has a sign without a meaning, as a
/// deflection or a torque, where the motion goes further to the other side: an optimum uses that.
std::vector<Finding> check_other_side(const TrustedRun& run);

}  // namespace pleuel
