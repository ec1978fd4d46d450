#pragma once

#include "core/trust/doubts.hpp"

namespace pleuel {

/// Beams that would buckle out of the plane in which they bend: by lateral–torsional buckling,
/// which the equations of motion do not have, or as columns, which motion in a plane does not see
/// and a straight member in space need not show. Serious beyond the critical load, mentioned from
/// three quarters of it on. The section forces of the worst instant count as if they lasted,
/// neighbours at joints as rigid. Warping of sections helps short I beams: a bent beam is serious
/// only beyond what flanges at the edges of its section could bear.
std::vector<Doubt> doubt_sideways_buckling(const TrustedRun& run);

}  // namespace pleuel
