#pragma once

#include "core/scene/body_constants.hpp"

namespace pleuel {

/// Which coordinates of a body are those of a reference, the body at a design nearby, and with which
/// signs: q of the file = T q of the reference. Modes come with any sign, and change places where their
/// frequencies cross. What a coordinate does (mean displacement, moments, places, stress) tells them apart.
/// @throws SimulationError if the number of coordinates, places, points or elements differ, or a
///         coordinate has no counterpart
SparseMatrix alignment_of(const InvariantsFile& reference, const InvariantsFile& file);

/// The same body, or a derivative of it, in other coordinates: q = T q_new.
BodyConstants in_coordinates(BodyConstants constants, const SparseMatrix& t);

}  // namespace pleuel
