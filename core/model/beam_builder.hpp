#pragma once

#include "core/model/build_context.hpp"
#include "core/model/model.hpp"

namespace pleuel {

/// Sets what is particular to a beam: elements, elastic coordinates (nodal, or a basis of modes or
/// of the mean axis), invariants and their derivatives.
void set_beam(const BeamBody& beam, const Body& body, const BuildContext& context,
              BodyModel& model);

}  // namespace pleuel
