#include "core/trust/energy_balance.hpp"

#include <fmt/format.h>

namespace pleuel {

namespace {

/// Share of the energy in motion. Errors of order h² are a few times larger in peaks than in
/// energy.
constexpr double small_energy_error = 1e-2;

}  // namespace

std::vector<Doubt> doubt_energy_balance(const TrustedRun& run) {
  if (run.monitors.energy_error <= small_energy_error) return {};
  return {
      {fmt::format("energy is balanced to {:.2g} % of the largest in the motion only: steps are "
                   "too long for what moves here, or a drive jumps. Compare with a smaller "
                   "/simulation/step.",
                   100.0 * run.monitors.energy_error)}};
}

}  // namespace pleuel
