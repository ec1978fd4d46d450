#pragma once

#include "core/trust/doubt.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Beams that would buckle out of the plane in which they bend: by lateral–torsional buckling,
/// which the equations of motion do not have, or as columns, which motion in a plane does not see
/// and a straight member in space need not show; and beams that stay straight in the plane of motion
/// where they would buckle in it. Mentioned from three quarters of the critical load
/// on, serious beyond it where compression alone is too large: with a bending moment the numbers
/// hold for a member that is held sideways. The section forces of each instant count as if
/// they lasted, neighbours at joints as rigid: where others are elastic, too, the mechanism is
/// judged as a whole besides (common_buckling.hpp). Warping of sections helps short I beams: a bent
/// beam is said to buckle only beyond what flanges at the edges of its section could bear.
std::vector<Doubt> doubt_sideways_buckling(const TrustedRun& run);

}  // namespace pleuel
