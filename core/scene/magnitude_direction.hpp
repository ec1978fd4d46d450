#pragma once

namespace pleuel {

/// In place of the number of a component of a vector (0 … 2): its magnitude is asked for.
inline constexpr int magnitude_direction = -1;

}  // namespace pleuel
