#pragma once

#include <array>
#include <memory>
#include <string>

#include "core/response/motion_signals.hpp"

namespace pleuel {

/// A place of an imported body.
/// @pre the body has it
NamedPoint named_point(const BodyModel& body, const std::string& place);

/// Deflection [m] of a place P of an imported body against the straight line through two other
/// ones, A and B, as small displacements in local axes:
///     u_P − (1 − s) u_A − s u_B,   s = (P − A)·(B − A)/|B − A|²
/// P need not be on the line: what is normal to it does not change with a small turn of the line.
/// @param variables  of the design
/// @param direction  0 … 2, local axes
std::unique_ptr<Signal> make_place_deflection(const BodyModel& body, const std::string& place,
                                              const std::array<std::string, 2>& ends, int variables,
                                              int direction);

}  // namespace pleuel
