#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/trust/doubt.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// A mechanism of more coordinates is not judged: its stiffness would have to be a dense matrix.
constexpr int most_judged_coordinates = 600;

/// Straight members in space, or in a plane on springs, that buckle without a trace in the motion:
/// the stiffness of the whole mechanism with its loads, rigid parts and inertia forces
/// (elastic_stability.hpp), at the instants at which beams are pressed most, each of them and all
/// together, and where all that turns does so alike, as shafts with disks, when that is fastest.
/// Serious. Where geometric stiffening is off, the mechanism is simulated once more with it.
/// Without springs nothing is looked for below a twentieth of the Euler load of a column as long as
/// all beams together; mechanisms of more than most_judged_coordinates are told of.
std::vector<Doubt> doubt_unstable_members(const TrustedRun& run);

/// Where and how a mechanism is not in stable equilibrium.
struct Instability {
  std::string text;    ///< a sentence without its full stop
  bool is_new = true;  ///< whether more is unstable than what is known
};

/// The same of a mechanism that was simulated in space: one that is new, if there is one.
/// @param known  how many negative eigenvalues of the stiffness are known otherwise at a time [s];
///               may be empty: none
std::optional<Instability> find_instability(const Scene& scene, const Analysis& analysis,
                                            const std::function<int(double)>& known = {});

}  // namespace pleuel
