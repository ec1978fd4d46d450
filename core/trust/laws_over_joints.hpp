#pragma once

#include "core/trust/doubt.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Loads that are functions of the coordinate of a joint, as cogging or the gas force of a crank, of
/// which the steps pass over most of a tooth or peak: what acts between two instants is not seen, and
/// runs with other steps may miss the same. Less than that they do see.
std::vector<Doubt> doubt_laws_over_joints(const TrustedRun& run);

/// Bodies that nothing drives and that turn by more than a quarter of a turn within a step: at whole
/// turns a step they seem to stand still.
std::vector<Doubt> doubt_fast_turning(const TrustedRun& run);

}  // namespace pleuel
