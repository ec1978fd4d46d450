#pragma once

/// Limits of a problem file that several readers share.
namespace pleuel {

/// Numbers of a file are written rounded: what is off by less than this share is meant to agree.
inline constexpr double rounding_tolerance = 1e-9;

inline constexpr int most_elements = 10000;  ///< of a segment
inline constexpr int most_modes = 1000;      ///< of a body

}  // namespace pleuel
