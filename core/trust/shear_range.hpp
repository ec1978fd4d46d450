#pragma once

#include <vector>

#include "core/trust/doubt.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Responses that shear of beams that leave it out would change. Where a beam is stubby
/// (stubby_beams.hpp), the mechanism is simulated once more, at twice the step (variants.hpp), with
/// shear in all of these beams (where that is serious, with each alone, to know which it is):
/// stubby beams pass loads on to others and to springs, change frequencies and reactions that are
/// shared. Told from 1 % of what a response is with shear, serious from 10 % of that or
/// of a tenth of its limits. What a change is relative to, response_changes.hpp says.
std::vector<Doubt> doubt_shear_range(const TrustedRun& run);

}  // namespace pleuel
