#pragma once

#include <string>
#include <vector>

#include "core/trust/doubt.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Whether members of a mechanism that moves in a plane buckle together with the elastic bodies
/// beside them, as the columns of a portal sway out of its plane, each of which would bear its load
/// with the others rigid. The mechanism is simulated once more, in space and with geometric
/// stiffening, and its stiffness judged (unstable_members.hpp). Serious where it buckles out of
/// the plane; mentioned where it does so in the plane, or where it could not be judged.
/// @param pressed  members that are pressed enough to buckle with others; not empty
std::vector<Doubt> doubt_common_buckling(const TrustedRun& run,
                                         const std::vector<std::string>& pressed);

}  // namespace pleuel
