#pragma once

namespace pleuel {

/// Instants (steps of a trajectory) at which a beam is deformed most, and how far.
struct LargestDeformation {
  int bending_step = 0, twist_step = 0, strain_step = 0;
  double bending = 0.0;  ///< rotation against the frame, without twist [rad]
  double twist = 0.0;    ///< about the axis [rad]
  double strain = 0.0;   ///< |Δu|/ℓ of an element
};

}  // namespace pleuel
