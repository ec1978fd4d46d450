#pragma once

/// Limits of a problem file that several readers share.
namespace pleuel {

/// Numbers of a file are written rounded: what is off by less than this share is meant to agree.
inline constexpr double rounding_tolerance = 1e-9;

/// Points may be off a beam by this share of its length, and off a point mass by this share of the
/// scene: far more than what rounding of written numbers costs, far less than what is meant.
inline constexpr double placement_tolerance = 1e-6;

inline constexpr int most_elements = 10000;  ///< of a segment
inline constexpr int most_modes = 1000;      ///< of a body
inline constexpr int most_iterations = 1000000;

}  // namespace pleuel
