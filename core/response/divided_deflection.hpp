#pragma once

#include <memory>

#include "core/response/signal.hpp"

namespace pleuel {

/// What a deflection of a beam in several frames is measured against.
enum class DividedReference {
  tangent,  ///< the axes at one end: n · (r_P − r_O), n the local y or z of the frame clamped there
  chord     ///< the line c = r_E − r_O through both ends: n normal to it
};

/// Vectors that a deflection of a divided beam is made from, three channels each, global axes.
struct DeflectionVectors {
  std::unique_ptr<Signal> place, origin, end;  ///< r_P, r_O, r_E [m]
  /// Tangent: n. Chord: the other lateral axis b of the first frame; n = b × c / |b × c| for local
  /// y, c × b / |c × b| for local z.
  std::unique_ptr<Signal> axis;
};

/// Deflection [m] of a place of a divided beam, for rotations of any size.
/// @param direction  1: local y, 2: local z
std::unique_ptr<Signal> make_divided_deflection(DeflectionVectors vectors,
                                                DividedReference reference, int direction);

}  // namespace pleuel
