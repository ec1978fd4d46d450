#pragma once

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Imported bodies whose constants are continued linearly to another design than that of their
/// file: nothing says how far they are still those of the body. Serious where a variable has moved
/// by more than 1e-4 of its value: then the square of that may matter beside an optimizer's
/// tolerance.
std::vector<Finding> check_extrapolation(const TrustedRun& run);

/// What slides along an elastic beam: the line of a joint belongs to the node at which the joint is
/// drawn, and does not bend with the beam, so that forces act there as by a rigid lever, wherever
/// the slider is. Right for a contact that stays, wrong for one that travels over the beam.
std::vector<Finding> check_sliding_contacts(const TrustedRun& run);

}  // namespace pleuel
